#include "experiments/studies/timing/timing_table.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace experiments {
namespace {

using Cell = analysis::CsvTable::Cell;

constexpr double steps_in_1_s = 100.0;

constexpr double none = std::numeric_limits<double>::quiet_NaN();  // an empty cell

void add(std::vector<Cell>& cells, double value)
{
    if (std::isnan(value))
        cells.emplace_back(std::nullopt);
    else
        cells.emplace_back(value);
}

const TableOneRow* row_of(const std::string& model)
{
    for (const TableOneRow& row : table_1())
        if (row.model == model) return &row;
    return nullptr;
}

struct Part {
    const char* name;
    Spread FrameTiming::*spread;
};
constexpr Part parts[] = {{"lbs", &FrameTiming::lbs_ms},
                          {"bind", &FrameTiming::bind_ms},
                          {"stretch", &FrameTiming::stretch_ms},
                          {"volume", &FrameTiming::volume_ms},
                          {"rest", &FrameTiming::rest_ms},
                          {"total", &FrameTiming::total_ms},
                          {"total_wall", &FrameTiming::total_wall_ms},
                          {"surface", &FrameTiming::surface_ms},
                          {"drawn_wall", &FrameTiming::drawn_wall_ms}};

std::vector<std::string> columns()
{
    std::vector<std::string> names = {"mesh",
                                      "body",
                                      "model",
                                      "stands_in",
                                      "vertices",
                                      "edges",
                                      "tets",
                                      "surface_vertices",
                                      "vertices_over_table_1",
                                      "edges_over_table_1",
                                      "tets_over_table_1",
                                      "variant",
                                      "precision",
                                      "rounds"};
    for (const Part& part : parts)
        for (const char* end : {"_ms", "_ms_low", "_ms_high"}) names.push_back(std::string(part.name) + end);
    for (const char* name : {"frames_per_s", "drawn_frames_per_s", "paper_frames_per_s", "paper_ms", "paper_ct_ms", "cpu_model"})
        names.emplace_back(name);
    return names;
}

analysis::CaseKey key_of(const TimedMesh& mesh, const FrameTiming& timing)
{
    return {.body = mesh.body,
            .motion = "01_01",
            .deformer = "pbs",
            .order = timing.variant,
            .precision = timing.precision,
            .vertices = mesh.vertices,
            .model = mesh.model};
}

analysis::Measurement milliseconds(const std::string& quantity, const analysis::CaseKey& of, const Spread& ms)
{
    return {"C10", quantity, of, ms.median, ms.lower, ms.upper, "ms"};
}

analysis::Measurement frames_per_s(const std::string& quantity, const analysis::CaseKey& of, const Spread& ms)
{
    return {"C10", quantity, of, 1e3 / ms.median, 1e3 / ms.upper, 1e3 / ms.lower, "1/s"};
}

analysis::Measurement over_table_1(const analysis::Measurement& ours, const TableOneRow& row)
{
    const double printed = row.frames_per_s;
    return {"C10", "frames_per_s_over_table_1", ours.of, ours.value / printed, ours.low / printed, ours.high / printed, "1"};
}

}  // namespace

analysis::CsvTable timing_table(const TimedMesh& mesh)
{
    const TableOneRow* row = row_of(mesh.model);
    const auto over = [&](int ours, auto printed) { return row ? double(ours) / row->*printed : none; };
    analysis::CsvTable table(columns());
    for (const FrameTiming& timing : mesh.timings) {
        std::vector<Cell> cells = {mesh.name,     mesh.body,  mesh.model, mesh.stands_in ? 1 : 0,
                                   mesh.vertices, mesh.edges, mesh.tets,  mesh.surface_vertices};
        add(cells, over(mesh.vertices, &TableOneRow::vertices));
        add(cells, over(mesh.edges, &TableOneRow::stretch));
        add(cells, over(mesh.tets, &TableOneRow::tets));
        cells.insert(cells.end(), {Cell(timing.variant), Cell(timing.precision), Cell(timing.total_ms.rounds)});
        for (const Part& part : parts) {
            const Spread& ms = timing.*part.spread;
            for (const double value : {ms.median, ms.lower, ms.upper}) add(cells, ms.rounds ? value : none);
        }
        add(cells, timing.frames_per_s());
        add(cells, timing.drawn_wall_ms.rounds ? 1e3 / timing.drawn_wall_ms.median : none);
        add(cells, row ? row->frames_per_s : none);
        add(cells, row ? 1e3 / row->frames_per_s : none);
        add(cells, row ? row->total_ms / steps_in_1_s : none);
        cells.emplace_back(mesh.cpu_model);
        table.add_row(cells);
    }
    return table;
}

std::vector<analysis::Measurement> timing_measurements(const TimedMesh& mesh)
{
    const TableOneRow* row = row_of(mesh.model);
    std::vector<analysis::Measurement> measured;
    if (!row) return measured;
    for (const FrameTiming& timing : mesh.timings) {
        const analysis::CaseKey of = key_of(mesh, timing);
        const analysis::Measurement by_wall = frames_per_s("frames_per_s", of, timing.total_wall_ms);
        measured.push_back(by_wall);
        if (timing.variant == "plain" && timing.precision == "f64")  // as the claim is judged
            measured.push_back(frames_per_s("frames_per_s_of_processor_time", of, timing.total_ms));
        measured.push_back(over_table_1(by_wall, *row));
        measured.push_back(milliseconds("lbs_ms", of, timing.lbs_ms));
        measured.push_back(milliseconds("bind_ms", of, timing.bind_ms));
        measured.push_back(milliseconds("stretch_ms", of, timing.stretch_ms));
        measured.push_back(milliseconds("volume_ms", of, timing.volume_ms));
        measured.push_back(milliseconds("total_ms", of, timing.total_ms));
    }
    return measured;
}

}  // namespace experiments

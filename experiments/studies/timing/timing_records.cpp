#include "experiments/studies/timing/timing_records.hpp"

#include "experiments/studies/shared/bodies.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace experiments {
namespace {

using analysis::Columns;
using analysis::within;

constexpr double steps_in_1_s = 100.0;

using Mesh = Columns<TimedMesh>;
const Mesh mesh_columns = {{"mesh", &TimedMesh::name, "", "name of the mesh"},
                           {"body", &TimedMesh::body, "", "name of the body"},
                           {"model", &TimedMesh::model, "", "row of Table 1 that it is made to; empty: a step of the ladder of sizes"},
                           {"stands_in", &TimedMesh::stands_in, "", "the body is not the one that the model names"},
                           {"vertices", &TimedMesh::vertices, "", "vertices of the tet mesh"},
                           {"edges", &TimedMesh::edges, "", "edges of the tet mesh"},
                           {"tets", &TimedMesh::tets, "", "tets of the mesh"},
                           {"surface_vertices", &TimedMesh::surface_vertices, "", "vertices of the embedded surface"}};
const Mesh machine_columns = {{"cpu_model", &TimedMesh::cpu_model, "", "the processor"}};

using Frame = Columns<FrameTiming>;
Frame spread(Spread FrameTiming::*part, const char* name, const char* meaning)
{
    return within(part, spread_columns(name, "ms", meaning));
}
const Frame frame_columns = Frame{{"variant", &FrameTiming::variant, "", "plain or ordered"},
                                  {"precision", &FrameTiming::precision, "", "f32 or f64"},
                                  {"rounds", [](auto& timing) -> decltype(auto) { return (timing.total_ms.rounds); }, "", "timed rounds"}} +
                            spread(&FrameTiming::lbs_ms, "lbs_ms", "LBS, processor time") +
                            spread(&FrameTiming::bind_ms, "bind_ms", "bind constraints, 24 iterations, processor time") +
                            spread(&FrameTiming::stretch_ms, "stretch_ms", "stretch constraints, 24 iterations, processor time") +
                            spread(&FrameTiming::volume_ms, "volume_ms", "volume constraints, 24 iterations, processor time") +
                            spread(&FrameTiming::rest_ms, "rest_ms", "a step without iterations, processor time") +
                            spread(&FrameTiming::total_ms, "total_ms", "the whole frame, processor time") +
                            spread(&FrameTiming::total_wall_ms, "total_wall_ms", "the whole frame, wall time") +
                            within(&FrameTiming::surface_ms, spread_columns("surface_ms", "ms", "the embedded surface, processor time")) +
                            within(&FrameTiming::drawn_wall_ms, spread_columns("drawn_wall_ms", "ms", "frame and surface, wall time"));

const TableOneRow* row_of(const std::string& model)
{
    const auto row = std::find_if(table_1().begin(), table_1().end(), [&](const TableOneRow& one) { return one.model == model; });
    return row == table_1().end() ? nullptr : &*row;
}

analysis::Measurement measured(const TimingRow& row, const std::string& quantity, double value, double low, double high,
                               const std::string& unit)
{
    const analysis::CaseKey of = {.body = row.mesh.body,
                                  .motion = "01_01",
                                  .deformer = "pbs",
                                  .order = row.timing.variant,
                                  .precision = row.timing.precision,
                                  .vertices = row.mesh.vertices,
                                  .model = row.mesh.model};
    return {"C10", quantity, of, value, low, high, unit};
}

// Frames per second over `baseline`.
analysis::Measurement frame_rate(const TimingRow& row, const std::string& quantity, const Spread& ms, double baseline = 1.0,
                                 const std::string& unit = "1/s")
{
    return measured(row, quantity, 1e3 / ms.median / baseline, 1e3 / ms.upper / baseline, 1e3 / ms.lower / baseline, unit);
}

}  // namespace

using Rows = Columns<TimingRow>;
const Rows timing_columns =
    within(&TimingRow::mesh, mesh_columns) +
    Rows{{"vertices_over_table_1", &TimingRow::vertices_over_table_1, "", "vertices over those of the model"},
         {"edges_over_table_1", &TimingRow::edges_over_table_1, "", "edges over the model's stretch constraints"},
         {"tets_over_table_1", &TimingRow::tets_over_table_1, "", "tets over those of the model"}} +
    within(&TimingRow::timing, frame_columns) +
    Rows{{"frames_per_s", &TimingRow::frames_per_s, "1/s", "frame rate by wall time"},
         {"drawn_frames_per_s", &TimingRow::drawn_frames_per_s, "1/s", "frame rate by wall time, with the surface"},
         {"paper_frames_per_s", &TimingRow::paper_frames_per_s, "1/s", "frame rate in Table 1"},
         {"paper_ms", &TimingRow::paper_ms, "ms", "time per frame by that frame rate"},
         {"paper_ct_ms", &TimingRow::paper_ct_ms, "ms", "time per step by the CT total of Table 1, which is of 100 steps"}} +
    within(&TimingRow::mesh, machine_columns);

std::vector<TimingRow> timing_rows(const TimedMesh& mesh, const std::vector<FrameTiming>& timings)
{
    std::vector<TimingRow> rows;
    for (const FrameTiming& timing : timings) {
        TimingRow row{.mesh = mesh, .timing = timing, .frames_per_s = 1e3 / timing.total_wall_ms.median};
        if (timing.drawn_wall_ms) row.drawn_frames_per_s = 1e3 / timing.drawn_wall_ms->median;
        if (const TableOneRow* paper = row_of(mesh.model)) {
            row.vertices_over_table_1 = double(mesh.vertices) / paper->vertices;
            row.edges_over_table_1 = double(mesh.edges) / paper->stretch;
            row.tets_over_table_1 = double(mesh.tets) / paper->tets;
            row.paper_frames_per_s = paper->frames_per_s;
            row.paper_ms = 1e3 / paper->frames_per_s;
            row.paper_ct_ms = paper->total_ms / steps_in_1_s;
        }
        rows.push_back(row);
    }
    return rows;
}

std::vector<analysis::Measurement> timing_measurements(const std::vector<TimingRow>& rows)
{
    std::vector<analysis::Measurement> all;
    for (const TimingRow& row : rows) {
        if (!row.paper_frames_per_s) continue;
        const FrameTiming& timing = row.timing;
        all.push_back(frame_rate(row, "frames_per_s", timing.total_wall_ms));
        if (timing.variant == "plain" && timing.precision == "f64")  // the variant that is judged
            all.push_back(frame_rate(row, "frames_per_s_of_processor_time", timing.total_ms));
        all.push_back(frame_rate(row, "frames_per_s_over_table_1", timing.total_wall_ms, *row.paper_frames_per_s, "1"));
        for (const auto& [quantity, ms] :
             {std::pair("lbs_ms", &timing.lbs_ms), std::pair("bind_ms", &timing.bind_ms), std::pair("stretch_ms", &timing.stretch_ms),
              std::pair("volume_ms", &timing.volume_ms), std::pair("total_ms", &timing.total_ms)})
            all.push_back(measured(row, quantity, ms->median, ms->lower, ms->upper, "ms"));
    }
    return all;
}

}  // namespace experiments

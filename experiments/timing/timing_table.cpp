#include "experiments/timing/timing_table.hpp"

#include "analysis/line_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace experiments {
namespace {

using Cell = analysis::CsvTable::Cell;

constexpr double real_time_ms = 1e3 / 30.0, steps_in_1_s = 100.0;

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
                          {"surface", &FrameTiming::surface_ms}};

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
    for (const char* name : {"frames_per_s", "paper_frames_per_s", "paper_ms", "paper_ct_ms"}) names.emplace_back(name);
    return names;
}

std::string of_mesh(const TimedMesh& mesh, const FrameTiming& timing)
{
    return fmt::format("{}, {} vertices, 01_01, {} {}, one core", mesh.body, mesh.vertices, timing.variant, timing.precision);
}

analysis::Measurement milliseconds(const std::string& quantity, const std::string& of, const Spread& ms)
{
    return {"C10", quantity, of, ms.median, ms.lower, ms.upper, "ms"};
}

std::string with_quartiles(const analysis::CsvTable& table, int row, const std::string& part)
{
    return fmt::format("{:.3g} [{:.3g}, {:.3g}]", table.number(row, part + "_ms"), table.number(row, part + "_ms_low"),
                       table.number(row, part + "_ms_high"));
}

std::string or_none(std::optional<double> value, const char* format)
{
    return value ? fmt::format(fmt::runtime(format), *value) : "-";
}

bool is_ladder(const analysis::CsvTable& table, int row)
{
    return table.text_at(row, "model").empty();
}

std::string ends_text(const analysis::CsvTable& table)
{
    std::string text;
    for (const auto& [variant, precision] : {std::pair("plain", "f64"), std::pair("plain", "f32"), std::pair("ordered", "f32")}) {
        std::vector<double> vertices, total_ms;
        for (int row = 0; row < table.rows(); ++row)
            if (is_ladder(table, row) && table.text_at(row, "variant") == variant && table.text_at(row, "precision") == precision) {
                vertices.push_back(table.number(row, "vertices"));
                total_ms.push_back(table.number(row, "total_ms"));
            }
        if (vertices.size() < 2) continue;
        const RealTimeEnd end = real_time_end(vertices, total_ms);
        text += fmt::format("  {:<8} {}: 30 frames a second up to {:.3g} vertices{}; ms a frame ~ vertices^{:.2f}\n", variant, precision,
                            end.vertices, end.beyond ? " (beyond what was measured)" : "", end.exponent);
    }
    return text;
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
        add(cells, row ? row->frames_per_s : none);
        add(cells, row ? 1e3 / row->frames_per_s : none);
        add(cells, row ? row->total_ms / steps_in_1_s : none);
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
        const std::string of = of_mesh(mesh, timing);
        const double fps = timing.frames_per_s(), low = 1e3 / timing.total_ms.upper, high = 1e3 / timing.total_ms.lower;
        const double printed = row->frames_per_s;
        measured.push_back({"C10", "frames a second", of, fps, low, high, "1/s"});
        measured.push_back(
            {"C10", "frames a second over Table 1's", of + ", " + row->model, fps / printed, low / printed, high / printed, "1"});
        measured.push_back(milliseconds("LBS", of, timing.lbs_ms));
        measured.push_back(milliseconds("bind", of, timing.bind_ms));
        measured.push_back(milliseconds("stretch", of, timing.stretch_ms));
        measured.push_back(milliseconds("volume", of, timing.volume_ms));
        measured.push_back(milliseconds("total", of, timing.total_ms));
    }
    return measured;
}

RealTimeEnd real_time_end(const std::vector<double>& vertices, const std::vector<double>& total_ms)
{
    std::vector<std::size_t> order(vertices.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return vertices[a] < vertices[b]; });
    std::size_t next = 1;  // the line through order[next - 1] and order[next]
    while (next + 1 < order.size() && total_ms[order[next]] < real_time_ms) ++next;
    const std::size_t a = order[next - 1], b = order[next];
    const double slope = std::log(total_ms[b] / total_ms[a]) / std::log(vertices[b] / vertices[a]);
    RealTimeEnd end;
    end.vertices = vertices[a] * std::pow(real_time_ms / total_ms[a], 1.0 / slope);
    end.beyond = end.vertices < vertices[order.front()] || end.vertices > vertices[order.back()];
    end.exponent = analysis::observed_order(vertices, total_ms).slope.estimate;
    return end;
}

std::string timing_markdown(const analysis::CsvTable& table)
{
    std::string text =
        "| mesh | stands for | V, E, T over Table 1's | order | LBS | bind | stretch | volume | rest | frame, processor [ms] | frame, wall "
        "[ms] | surface | frames/s | Table 1: frames/s | ms by its frame rate | ms by its CT |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
    for (int row = 0; row < table.rows(); ++row) {
        const auto ratio = [&](const char* of) {
            return or_none(table.number_or_nothing(row, std::string(of) + "_over_table_1"), "{:.2f}");
        };
        text += fmt::format(
            "| {} ({}, {}, {}) | {} | {}, {}, {} | {} {} | {} | {} | {} | {} | {} | {} | {} | {} | {:.0f} | {} | {} | {} |\n",
            table.text_at(row, "body"), table.integer(row, "vertices"), table.integer(row, "edges"), table.integer(row, "tets"),
            is_ladder(table, row) ? "-" : table.text_at(row, "model"), ratio("vertices"), ratio("edges"), ratio("tets"),
            table.text_at(row, "variant"), table.text_at(row, "precision"), with_quartiles(table, row, "lbs"),
            with_quartiles(table, row, "bind"), with_quartiles(table, row, "stretch"), with_quartiles(table, row, "volume"),
            with_quartiles(table, row, "rest"), with_quartiles(table, row, "total"), with_quartiles(table, row, "total_wall"),
            or_none(table.number_or_nothing(row, "surface_ms"), "{:.3g}"), table.number(row, "frames_per_s"),
            or_none(table.number_or_nothing(row, "paper_frames_per_s"), "{:.1f}"),
            or_none(table.number_or_nothing(row, "paper_ms"), "{:.2f}"), or_none(table.number_or_nothing(row, "paper_ct_ms"), "{:.2f}"));
    }
    return text +
           "\nAt most one of the paper's two columns of times can be right: its frame rate and its CT of 100 steps differ by a factor of "
           "20.\n\n```\n" +
           ends_text(table) + "```\n";
}

std::string timing_text(const analysis::CsvTable& table)
{
    std::string text = fmt::format("{:<24} {:<12} {:>7} {:>7} {:>7} {:>7} {:>22} {:>9} {:>9}\n", "ms a frame, one core", "", "LBS", "bind",
                                   "stretch", "volume", "frame", "frames/s", "Table 1");
    for (int row = 0; row < table.rows(); ++row)
        text += fmt::format("  {:<22} {:<12} {:>7.3f} {:>7.3f} {:>7.3f} {:>7.3f} {:>22} {:>9.0f} {:>9}\n",
                            fmt::format("{} {}", table.text_at(row, "body"), table.integer(row, "vertices")),
                            table.text_at(row, "variant") + " " + table.text_at(row, "precision"), table.number(row, "lbs_ms"),
                            table.number(row, "bind_ms"), table.number(row, "stretch_ms"), table.number(row, "volume_ms"),
                            with_quartiles(table, row, "total"), table.number(row, "frames_per_s"),
                            or_none(table.number_or_nothing(row, "paper_frames_per_s"), "{:.1f}"));
    return text + ends_text(table);
}

}  // namespace experiments

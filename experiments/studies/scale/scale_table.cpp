#include "experiments/studies/scale/scale_table.hpp"

#include <fmt/format.h>

namespace experiments {
namespace {

const std::pair<const char*, const char*> grown[] = {
    {"step_ms", "a step"},     {"character_s", "mesh, weights, surface"}, {"set_up_s", "set-up of the deformers"},
    {"ruler_ms", "the ruler"}, {"write_ms", "a frame on disk"},           {"peak_mb", "peak memory"},
};

std::string exponents_text(const analysis::CsvTable& table)
{
    std::string text;
    for (const auto& [column, meaning] : grown) {
        const analysis::Interval p = growth_exponent(table, column);
        text += fmt::format("| {} | {:.2f} [{:.2f}, {:.2f}] |\n", meaning, p.estimate, p.low, p.high);
    }
    return text;
}

}  // namespace

ScaleRow scale_row(const nlohmann::json& run, const analysis::CsvTable& metrics)
{
    ScaleRow row;
    const nlohmann::json &character = run.at("character"), &seconds = run.at("cost").at("cpu_seconds");
    row.vertices = character.at("vertices");
    row.edges = character.at("quality").at("edges");
    row.tets = character.at("tets");
    row.frames = run.at("outcome").at("frames");
    for (int i = 0; i < metrics.rows(); ++i)
        if (metrics.text_at(i, "deformer") == "pbs") row.iterations = static_cast<int>(metrics.integer(i, "iterations"));
    row.step_ms = 1e3 * seconds.at("deformers").at("pbs").at("step").get<double>() / row.frames;
    row.character_s = seconds.at("character");
    row.set_up_s = seconds.at("set_up");
    row.ruler_set_up_s = seconds.at("ruler_set_up");
    row.records_s = seconds.at("records");
    row.total_s = seconds.at("total");
    row.ruler_ms = 1e3 * seconds.at("ruler").get<double>() / metrics.rows();
    row.write_ms = 1e3 * seconds.at("frames").get<double>() / metrics.rows();
    row.peak_mb = run.at("cost").at("peak_memory_mb");
    return row;
}

analysis::CsvTable scale_csv(const std::vector<ScaleRow>& rows)
{
    analysis::CsvTable table({"vertices", "edges", "tets", "constraints", "iterations", "frames", "step_ms", "ns_a_constraint",
                              "character_s", "set_up_s", "ruler_set_up_s", "ruler_ms", "write_ms", "records_s", "total_s", "peak_mb"});
    for (const ScaleRow& row : rows)
        table.add_row({row.vertices, row.edges, row.tets, row.constraints(), row.iterations, row.frames, row.step_ms, row.ns_a_constraint(),
                       row.character_s, row.set_up_s, row.ruler_set_up_s, row.ruler_ms, row.write_ms, row.records_s, row.total_s,
                       row.peak_mb});
    return table;
}

analysis::Interval growth_exponent(const analysis::CsvTable& table, const std::string& column)
{
    return analysis::observed_order(table.numbers("constraints"), table.numbers(column)).slope;
}

std::string scale_markdown(const analysis::CsvTable& table)
{
    std::string text =
        "| tets | constraints | step [ms] | ns a constraint and iteration | mesh, weights, surface [s] | set-up [s] | ruler [ms a frame] "
        "| frame on disk [ms] | whole run [s] | frames | peak [MB] |\n|---|---|---|---|---|---|---|---|---|---|---|\n";
    for (int row = 0; row < table.rows(); ++row)
        text += fmt::format("| {} | {:.0f} | {:.3g} | {:.2f} | {:.3g} | {:.3g} | {:.3g} | {:.3g} | {:.3g} | {} | {:.0f} |\n",
                            table.integer(row, "tets"), table.number(row, "constraints"), table.number(row, "step_ms"),
                            table.number(row, "ns_a_constraint"), table.number(row, "character_s"),
                            table.number(row, "set_up_s") + table.number(row, "ruler_set_up_s"), table.number(row, "ruler_ms"),
                            table.number(row, "write_ms"), table.number(row, "total_s"), table.integer(row, "frames"),
                            table.number(row, "peak_mb"));
    if (table.rows() < 2) return text;
    return text + "\n| cost of | grows with constraints^p, p [95 %] |\n|---|---|\n" + exponents_text(table);
}

}  // namespace experiments

#include "analysis/records/report_table.hpp"
#include "experiments/studies/bench/bench.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace experiments {
namespace {

using nlohmann::json;

constexpr double quiet_processors = 0.5;  // of other work

constexpr const char* legend =
    "\nRead ratios, not times. A step is 24 iterations; ns_stretch, ns_volume and ns_bind are per constraint. ratio_to_plain_spread:\n"
    "times faster than plain loops, with all that this compiler offers, on constraints whose neighbours in the list share no vertex, so\n"
    "that none waits for the stores of the one before; ratio_to_plain: than order `plain`, which is built for the same bits on every\n"
    "machine and whose projections wait for each other's stores; ratio_to_plain_native: than the loops of `plain` with all that this\n"
    "compiler offers. Orders give different answers: residual_to_plain_spread and volume_rms_to_plain_spread are the combined residual "
    "and\n"
    "the root mean square volume error after the step over those of the same loops, and _to_plain over those of `plain`; above 1 is a "
    "loss.\n"
    "The study equal_quality compares the times to equal answers. ms_floor: the time that\n"
    "moving the bytes takes. exponent: the cost\n"
    "of a step is ~ constraints^exponent. Deformers: ns_tet and ns_vertex are per iteration, or per frame of a deformer without\n"
    "iterations; ratio_to_plain: to the plain implementation of the same deformer. The last table has the finite elements: ns_element is "
    "per\n"
    "further frame of linear elements (a solve), and per Newton step of neo-Hookean ones. They have no plain implementation.\n";

// One line per entry of bench.json. Each column is a place inside the entry, with a format for a number.
std::string table(const json& entries, const std::string& places)
{
    if (entries.empty()) return "";
    const std::vector<analysis::ReportColumn> columns = analysis::report_columns(places);
    std::vector<std::string> names;
    for (const analysis::ReportColumn& column : columns) names.push_back(column.column);
    analysis::CsvTable cells(names);
    for (const json& entry : entries) {
        std::vector<analysis::CsvTable::Cell> row;
        for (const std::string& name : names) {
            const json value = entry.value(json::json_pointer("/" + name), json());
            if (value.is_number())
                row.emplace_back(value.get<double>());
            else
                row.emplace_back(value.is_string() ? value.get<std::string>() : "");
        }
        cells.add_row(row);
    }
    return fmt::format("\n{}", text_table(cells, columns));
}

std::string mesh_text(const json& timed)
{
    json projections = timed.at("results");
    for (const json& baseline : timed.at("yardsticks")) projections.push_back(baseline);
    const std::string kind = "variant precision threads:.0f ";
    std::string text = table(json::array({timed}), "mesh/name mesh/vertices:.0f mesh/edges:.0f mesh/tets:.0f memory/growth_bytes:.3g");
    text += table(projections, kind +
                                   "poses:.0f ns_stretch:.3f ns_volume:.3f ns_bind:.3f ms_step:.4g quartiles/ms_step/0:.4g "
                                   "quartiles/ms_step/1:.4g ratio_to_plain_spread:.2f residual_to_plain_spread:.3f "
                                   "volume_rms_to_plain_spread:.3f ratio_to_plain:.2f residual_to_plain:.3f volume_rms_to_plain:.3f "
                                   "ratio_to_plain_native:.2f");
    text += table(projections, kind + "ms_floor:.2g best_speedup_by_threads:.2f");
    text += table(timed.at("skinning"), "blend variant precision ns_vertex:.3f gb_s:.1f ratio_to_plain:.2f");
    text +=
        table(timed.at("deformers"),
              "deformer order precision iterations:.0f ms_frame:.4g ms_iteration:.4g ns_tet:.2f ns_vertex:.2f ratio_to_plain:.2f left_out");
    text += table(timed.at("fem"),
                  "model element_order:.0f ms_first_solve:.4g ms_further_frame:.4g further_to_first:.2g newton_steps:.0f ms_frame:.4g "
                  "ms_newton_step:.4g ns_element:.4g");
    if (timed.contains("fem_left_out")) text += fmt::format("\nfem is left out: {}\n", timed.at("fem_left_out").get<std::string>());
    return text;
}

}  // namespace

std::string bench_table(const BenchRecord& record)
{
    const json bench = bench_json(record), &context = bench.at("context");
    std::string text =
        table(json::array({context}), "cpu cores:.0f busy_processors/0:.2f busy_processors/1:.2f kernel_instructions compiler");
    if (std::max(record.busy_before.value_or(0.0), record.busy_after.value_or(0.0)) > quiet_processors)
        text += "Other work ran before or after: wall times, and so threads, are worth little.\n";
    text += "\nOne core, bytes read and written:\n";
    text += table(context.at("limits_of_one_core").at("memory"), "bytes:.0f gb_s:.0f");
    for (const json& mesh : bench.at("meshes")) text += mesh_text(mesh);
    return text + table(bench.value("scaling", json::array()), "variant precision threads:.0f exponent:.3f interval/0:.3f interval/1:.3f") +
           legend;
}

}  // namespace experiments

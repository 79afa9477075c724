#include "experiments/studies/stiffness/stiffness_report.hpp"

#include "analysis/records/report_table.hpp"
#include "analysis/verdicts/measurement.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace experiments {
namespace {

using Ratio = analysis::Measurement;

analysis::CsvTable ratio_table(Varied varied, const std::vector<Ratio>& ratios)
{
    const analysis::Columns<Ratio> columns = {
        {"at", [varied](const Ratio&) { return std::string(text_of(varied).doubled); }, "", "what is doubled"},
        {"case", [](const Ratio& ratio) { return text_of(ratio.of); }, "", "everything else"},
        {"body", [](const Ratio& ratio) { return ratio.of.body + ", " + ratio.of.load; }, "", "body and load"},
        {"deformer", [](const Ratio& ratio) { return ratio.of.deformer; }, "", "the solver"},
        {"ratio", &Ratio::value, "", "of the stiffnesses, for one doubling"},
        {"least", &Ratio::low, "", "the least of every single doubling"},
        {"largest", &Ratio::high, "", "the largest of every single doubling"}};
    return table_of(columns, ratios);
}

const analysis::Columns<StiffnessExponent> case_columns = {
    {"case", [](const StiffnessExponent& row) { return text_of(row.of); }, "", "everything that is not varied"}};

const std::vector<analysis::ReportColumn> shown_columns = {
    {"at", "at"}, {"case", "case"}, {"ratio", "ratio", "{:.4g}"}, {"least", "least", "{:.4g}"}, {"largest", "largest", "{:.4g}"}};

template <typename Wanted>
std::vector<Ratio> ratios_where(const SweptRows& sweep, const Wanted& wanted)
{
    std::vector<StiffnessRow> rows;
    std::ranges::copy_if(sweep.second, std::back_inserter(rows), wanted);
    return stiffness_ratios(rows, sweep.first);
}

// By the linear map: PBS at k_stretch 0.2, the same with the exponent, and the softer XPBD.
bool is_in_short(const StiffnessRow& row)
{
    if (row.by != "linear") return false;
    if (row.setting.method == Method::xpbd) return row.setting.young_pa == 3.0e4;
    return !is_xpbd(row.setting.method) && row.setting.k_stretch == 0.2;
}

std::vector<Ratio> control_ratios(const SweptRows& sweep, bool forgets_multipliers)
{
    return ratios_where(sweep, [&](const StiffnessRow& row) {
        return is_xpbd(row.setting.method) && (row.setting.method == Method::xpbd_forgetting) == forgets_multipliers;
    });
}

bool stays(const analysis::Claim& claim, const Ratio& measured)
{
    return analysis::extent_of(claim, measured) == analysis::Extent::whole;
}

}  // namespace

std::string stiffness_markdown(const std::vector<SweptRows>& sweeps)
{
    std::string text = "# Effective stiffness\n\nWeight of the jiggling zone, or of a bar's free length, over its mean displacement.\n";
    for (const auto& [varied, rows] : sweeps) {
        text += fmt::format("\n## Ratio at {}\n\n", text_of(varied).doubled);
        text += markdown_table(ratio_table(varied, stiffness_ratios(rows, varied)), shown_columns);
        text += fmt::format("\n## Stiffness ~ ({})^p\n\n", text_of(varied).factor);
        text += markdown_table(table_of(case_columns + exponent_columns(), stiffness_exponents(rows, varied)),
                               {{"case", "case"},
                                {"from", "first", "{:.4g}"},
                                {"to", "last", "{:.4g}"},
                                {"p", "exponent", "{:.3f}"},
                                {"p, low", "exponent_low", "{:.3f}"},
                                {"p, high", "exponent_high", "{:.3f}"},
                                {"left out", "left_out"}});
    }
    return text;
}

std::string stiffness_text(const std::vector<SweptRows>& sweeps)
{
    analysis::CsvTable lines{{}};
    for (const SweptRows& sweep : sweeps) lines.append(ratio_table(sweep.first, ratios_where(sweep, is_in_short)));
    return "ratio of stiffnesses for one doubling: PBS at k_stretch 0.2, the same with the exponent, XPBD at 30 kPa\n" +
           text_table(lines, {{"at", "at"},
                              {"body", "body"},
                              {"deformer", "deformer"},
                              {"ratio", "ratio", "{:.3g}"},
                              {"least", "least", "{:.3g}"},
                              {"largest", "largest", "{:.3g}"}});
}

std::string control_text(const std::vector<SweptRows>& sweeps, const analysis::Claim& claim)
{
    std::string text;
    for (const bool forgets : {false, true})
        for (const SweptRows& sweep : sweeps) {
            const auto measured = control_ratios(sweep, forgets);
            if (measured.empty()) continue;
            text += fmt::format("the control, XPBD{}, at {}: {} of {} values lie within {}\n", forgets ? " without its multipliers" : "",
                                text_of(sweep.first).doubled,
                                std::ranges::count_if(measured, [&](const Ratio& one) { return stays(claim, one); }), measured.size(),
                                analysis::bound_text(analysis::bound_of(claim, measured.front().quantity)));
        }
    return text;
}

std::string control_markdown(const std::vector<SweptRows>& sweeps, const analysis::Claim& claim)
{
    analysis::CsvTable lines{{}};
    for (const SweptRows& sweep : sweeps) {
        std::vector<Ratio> outside = control_ratios(sweep, false);
        std::erase_if(outside, [&](const Ratio& ratio) { return stays(claim, ratio); });
        lines.append(ratio_table(sweep.first, outside));
    }
    const std::string table = lines.rows() == 0 ? "Nowhere.\n" : markdown_table(lines, shown_columns);
    return "\n## Where XPBD, the control, leaves the claim's bounds\n\n" + table;
}

}  // namespace experiments

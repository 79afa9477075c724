#include "experiments/studies/stiffness/stiffness_report.hpp"

#include "analysis/measurement.hpp"
#include "analysis/report_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace experiments {
namespace {

using Ratio = analysis::Measurement;

struct RatioLine {
    std::string at, of, body, deformer;
    double ratio = 0.0, least = 0.0, largest = 0.0;
};
const analysis::Columns<RatioLine> ratio_columns = {{"at", &RatioLine::at, "", "what is doubled"},
                                                    {"case", &RatioLine::of, "", "everything else: the fields of its case"},
                                                    {"body", &RatioLine::body, "", "body and load"},
                                                    {"deformer", &RatioLine::deformer, "", "the solver"},
                                                    {"ratio", &RatioLine::ratio, "", "of the stiffnesses, for one doubling"},
                                                    {"least", &RatioLine::least, "", "the least of every single doubling"},
                                                    {"largest", &RatioLine::largest, "", "the largest of every single doubling"}};

std::vector<RatioLine> lines_of(Varied varied, const std::vector<Ratio>& ratios)
{
    std::vector<RatioLine> lines;
    for (const Ratio& ratio : ratios)
        lines.push_back({text_of(varied).doubled, text_of(ratio.of), ratio.of.body + ", " + ratio.of.load, ratio.of.deformer, ratio.value,
                         ratio.low, ratio.high});
    return lines;
}

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

// The end of the interval that is farther from one.
double farther_end(const Ratio& measured)
{
    return std::abs(std::log(measured.low)) > std::abs(std::log(measured.high)) ? measured.low : measured.high;
}

}  // namespace

std::string stiffness_markdown(const std::vector<SweptRows>& sweeps)
{
    std::string text = "# Effective stiffness\n\nWeight of the jiggling zone, or of a bar's free length, over its mean displacement.\n";
    for (const auto& [varied, rows] : sweeps) {
        text += fmt::format("\n## Ratio at {}\n\n", text_of(varied).doubled);
        text += markdown_table(table_of(ratio_columns, lines_of(varied, stiffness_ratios(rows, varied))), shown_columns);
        text += fmt::format("\n## Stiffness ~ ({})^p\n\n", text_of(varied).factor);
        text += markdown_table(table_of(exponent_columns, stiffness_exponents(rows, varied)), {{"case", "case"},
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
    std::vector<RatioLine> lines;
    for (const SweptRows& sweep : sweeps)
        std::ranges::copy(lines_of(sweep.first, ratios_where(sweep, is_in_short)), std::back_inserter(lines));
    return "ratio of stiffnesses for one doubling: PBS at k_stretch 0.2, the same with the exponent, XPBD at 30 kPa\n" +
           text_table(table_of(ratio_columns, lines), {{"at", "at"},
                                                       {"body", "body"},
                                                       {"deformer", "deformer"},
                                                       {"ratio", "ratio", "{:.3g}"},
                                                       {"least", "least", "{:.3g}"},
                                                       {"largest", "largest", "{:.3g}"}});
}

std::string control_text(const std::vector<SweptRows>& sweeps, const analysis::Claim& claim)
{
    const auto distance = [](const Ratio& measured) { return std::abs(std::log(farther_end(measured))); };
    std::string text;
    for (const bool forgets : {false, true})
        for (const SweptRows& sweep : sweeps) {
            const auto measured = control_ratios(sweep, forgets);
            if (measured.empty()) continue;
            const auto within = std::ranges::count_if(measured, [&](const Ratio& one) { return stays(claim, one); });
            const Ratio& farthest = *std::ranges::max_element(measured, {}, distance);
            text += fmt::format("the control, XPBD{}, at {}: {} of {} values stay within {}; farthest {:.3g}, of {}\n",
                                forgets ? " without its multipliers" : "", text_of(sweep.first).doubled, within, measured.size(),
                                analysis::bound_text(analysis::bound_of(claim, farthest.quantity)), farther_end(farthest),
                                text_of(farthest.of));
        }
    return text;
}

std::string control_markdown(const std::vector<SweptRows>& sweeps, const analysis::Claim& claim)
{
    std::vector<RatioLine> lines;
    for (const SweptRows& sweep : sweeps) {
        std::vector<Ratio> outside = control_ratios(sweep, false);
        std::erase_if(outside, [&](const Ratio& ratio) { return stays(claim, ratio); });
        std::ranges::copy(lines_of(sweep.first, outside), std::back_inserter(lines));
    }
    const std::string table = lines.empty() ? "Nowhere.\n" : markdown_table(table_of(ratio_columns, lines), shown_columns);
    return "\n## Where XPBD, the control, leaves the claim's bounds\n\n" + table;
}

}  // namespace experiments

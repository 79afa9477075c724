#include "experiments/studies/stiffness/stiffness_report.hpp"

#include "analysis/measurement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace experiments {
namespace {

const char* name_of(Varied varied)
{
    return varied == Varied::iterations ? "iterations" : varied == Varied::time_step ? "1 / time step" : "vertices";
}

const char* doubled(Varied varied)
{
    return varied == Varied::iterations  ? "twice the iterations"
           : varied == Varied::time_step ? "half the time step"
                                         : "twice the vertices";
}

double shown(Varied varied, double x)
{
    return varied == Varied::time_step ? 1e3 / x : x;  // a time step [ms]
}

bool is_shown(const StiffnessRow& row)
{
    const StiffnessSetting& setting = row.setting;
    if (row.by != "linear" || setting.method == Method::xpbd_small_steps) return false;
    return is_xpbd(setting.method) ? setting.young_pa == 3.0e4 : setting.k_stretch == 0.2;
}

std::string ratio_text(const analysis::Measurement& measured)
{
    return fmt::format("{:.3g} [{:.3g}, {:.3g}]", measured.value, measured.low, measured.high);
}

// body, load -> PBS, exponent, XPBD.
using Columns = std::map<Method, std::string>;
std::map<std::string, Columns> shown_ratios(const SweptRows& sweep)
{
    std::map<std::string, std::vector<StiffnessRow>> of_body;
    for (const StiffnessRow& row : sweep.second)
        if (is_shown(row)) of_body[row.body + ", " + row.load].push_back(row);
    std::map<std::string, Columns> columns;
    for (const auto& [body, rows] : of_body)
        for (const Method method : {Method::pbs, Method::exponent, Method::xpbd}) {
            std::vector<StiffnessRow> of_method;
            for (const StiffnessRow& row : rows)
                if (row.setting.method == method) of_method.push_back(row);
            const auto measured = stiffness_ratios(of_method, sweep.first);
            columns[body][method] = measured.empty() ? "-" : ratio_text(measured.front());
        }
    return columns;
}

enum class Multipliers { kept, forgotten };

std::vector<analysis::Measurement> control_ratios(const SweptRows& sweep, Multipliers multipliers)
{
    const bool forgets = multipliers == Multipliers::forgotten;
    std::vector<StiffnessRow> rows;
    for (const StiffnessRow& row : sweep.second)
        if (is_xpbd(row.setting.method) && (row.setting.method == Method::xpbd_forgetting) == forgets) rows.push_back(row);
    return stiffness_ratios(rows, sweep.first);
}

bool stays(const analysis::Claim& claim, const analysis::Measurement& measured)
{
    return analysis::extent_of(claim, measured) == analysis::Extent::whole;
}

// The end of the interval that is farther from one.
double farther_end(const analysis::Measurement& measured)
{
    return std::abs(std::log(measured.low)) > std::abs(std::log(measured.high)) ? measured.low : measured.high;
}

}  // namespace

analysis::CsvTable exponents_table(const std::vector<SweptRows>& sweeps)
{
    analysis::CsvTable table({"varied", "case", "first", "last", "points", "left_out", "exponent", "exponent_low", "exponent_high"});
    for (const auto& [varied, rows] : sweeps)
        for (const StiffnessExponent& found : stiffness_exponents(rows, varied))
            table.add_row({std::string(name_of(varied)), found.what, shown(varied, found.first), shown(varied, found.last),
                           found.fit.slope.n, found.left_out, found.fit.slope.estimate, found.fit.slope.low, found.fit.slope.high});
    return table;
}

std::string stiffness_markdown(const std::vector<SweptRows>& sweeps)
{
    std::string text = "# Effective stiffness\n\nWeight of the jiggling zone, or of a bar's free length, over its mean displacement.\n";
    for (const auto& [varied, rows] : sweeps) {
        text += fmt::format("\n## Ratio at {}\n\n| case | ratio | least to most |\n|---|---|---|\n", doubled(varied));
        for (const auto& measured : stiffness_ratios(rows, varied))
            text += fmt::format("| {} | {:.4g} | {:.4g} to {:.4g} |\n", text_of(measured.of), measured.value, measured.low, measured.high);
        text += fmt::format("\n## Stiffness ~ ({})^p\n\n| case | from | to | p | 95 % | left out |\n|---|---|---|---|---|---|\n",
                            name_of(varied));
        for (const StiffnessExponent& found : stiffness_exponents(rows, varied))
            text +=
                fmt::format("| {} | {:.4g} | {:.4g} | {:.3f} | {:.3f} to {:.3f} | {} |\n", found.what, shown(varied, found.first),
                            shown(varied, found.last), found.fit.slope.estimate, found.fit.slope.low, found.fit.slope.high, found.left_out);
    }
    return text;
}

std::string stiffness_text(const std::vector<SweptRows>& sweeps)
{
    std::string text;
    for (const SweptRows& sweep : sweeps) {
        text += fmt::format("stiffness at {:<30} {:<26} {:<26} {}\n", doubled(sweep.first), "PBS, k_stretch 0.2", "k' = 1-(1-k)^(1/n)",
                            "XPBD, 30 kPa");
        for (const auto& [body, columns] : shown_ratios(sweep))
            text += fmt::format("  {:<41} {:<26} {:<26} {}\n", body, columns.at(Method::pbs), columns.at(Method::exponent),
                                columns.at(Method::xpbd));
    }
    return text;
}

std::string control_text(const std::vector<SweptRows>& sweeps, const analysis::Claim& claim)
{
    std::string text;
    for (const auto& [multipliers, name] : {std::pair{Multipliers::kept, "XPBD"}, {Multipliers::forgotten, "XPBD without its multipliers"}})
        for (const SweptRows& sweep : sweeps) {
            const auto measured = control_ratios(sweep, multipliers);
            if (measured.empty()) continue;
            const auto within = std::count_if(measured.begin(), measured.end(), [&](const auto& one) { return stays(claim, one); });
            const auto& farthest = *std::max_element(measured.begin(), measured.end(), [](const auto& a, const auto& b) {
                return std::abs(std::log(farther_end(a))) < std::abs(std::log(farther_end(b)));
            });
            text +=
                fmt::format("the control, {}, at {}: {} of {} values stay within {}; farthest {:.3g}, of {}\n", name, doubled(sweep.first),
                            within, measured.size(), analysis::bound_text(analysis::bound_of(claim, farthest.quantity)),
                            farther_end(farthest), text_of(farthest.of));
        }
    return text;
}

std::string control_markdown(const std::vector<SweptRows>& sweeps, const analysis::Claim& claim)
{
    std::string text;
    for (const SweptRows& sweep : sweeps)
        for (const auto& measured : control_ratios(sweep, Multipliers::kept))
            if (!stays(claim, measured))
                text += fmt::format("| {} | {} | {:.4g} | {:.4g} to {:.4g} |\n", doubled(sweep.first), text_of(measured.of), measured.value,
                                    measured.low, measured.high);
    if (text.empty()) text = "| none | | | |\n";
    return "\n## Where XPBD, the control, leaves the claim's bounds\n\n| at | case | ratio | least to most |\n|---|---|---|---|\n" + text;
}

}  // namespace experiments

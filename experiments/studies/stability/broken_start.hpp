// Does a deformer that minimises an energy find its own result again from a broken initial shape, and after how many iterations?
//   for (const StabilityCell& cell : start_cells(full)) rows.push_back(run_broken_start(cell, most_iterations));
// The deformer runs from the broken shape with 1, 2, 4, ... iterations, up to the most, and once with the most from its own initial guess.
// The result of the latter is its own result. These runs differ from a scene only in the initial shape and in the number of iterations.
// The outcomes in cells.csv cannot show this: there a deformer without memory forgets a broken shape after one step.
#pragma once

#include "analysis/records/tables.hpp"
#include "experiments/studies/stability/stability_cell.hpp"

#include <optional>
#include <string>
#include <vector>

namespace experiments {

// The distance from the deformer's own result below which it counts as reached: root mean square over the vertices at the joints, over
// their mean distance to the bones.
inline constexpr double reached_within_pct = 1.0;

// diverged: a vertex is farther than a diagonal of the body from its place in the own result (StabilityBounds::farthest).
enum class StartOutcome { reached, not_reached, diverged, not_finite, not_applicable };

// A row of starts.csv.
struct StartRow {
    std::string body, model, precision;
    std::string pose;                     // bend_90, twist_90
    std::string start;                    // flattened, mirrored, random, point
    std::string setting;                  // the option that the row changes; empty: all have their defaults
    std::optional<double> setting_value;  // its value
    StartOutcome outcome = StartOutcome::not_reached;
    std::optional<int> iterations_until_reached;  // the first number of iterations from which on all are within the distance
    int most_iterations = 0;
    std::optional<double> from_own_result_pct;  // after the most iterations; empty: not finite
    std::optional<double> own_change_pct;       // of the own result in the second half of the iterations; empty: not finite
    std::optional<int> inverted_tets, own_inverted_tets;
    std::string reason;  // why a start is not applicable
    double cpu_s = 0.0;
};
extern const analysis::Columns<StartRow> start_columns;

// The broken starts of every deformer that minimises an energy: bent and twisted, with default settings, near incompressibility, and with
// settings beyond those for which the methods are known to converge.
std::vector<StabilityCell> start_cells(bool full);

StartRow run_broken_start(const StabilityCell& cell, int most_iterations);

// The other deformers of the map, with the reason why they have no broken start.
std::vector<StartRow> starts_not_applicable();

std::string start_table(const std::vector<StartRow>& rows);  // counts by model and setting, as aligned columns
std::string start_criteria_text(int most_iterations);        // the definitions in words, as Markdown

}  // namespace experiments

template <>
struct analysis::EnumNames<experiments::StartOutcome> {
    static constexpr std::array<std::pair<experiments::StartOutcome, const char*>, 5> table{
        {{experiments::StartOutcome::reached, "reached"},
         {experiments::StartOutcome::not_reached, "not_reached"},
         {experiments::StartOutcome::diverged, "diverged"},
         {experiments::StartOutcome::not_finite, "not_finite"},
         {experiments::StartOutcome::not_applicable, "not_applicable"}}};
};

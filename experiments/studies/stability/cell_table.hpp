// The outcomes of a run's cells as records: cells.csv, the shares by which C08 is judged, and tables for reading.
#pragma once

#include "analysis/records/tables.hpp"
#include "experiments/studies/stability/cell_run.hpp"
#include "experiments/studies/stability/stability_cells.hpp"

#include <optional>
#include <string>
#include <vector>

namespace experiments {

struct MeasuredCell {
    StabilityCell cell;
    CellResult result;
};

// A row of cells.csv: a cell and its outcome.
struct CellRow {
    std::string body, model, factor;
    double value = 0.0;
    std::string unit, named, second_factor;
    std::optional<double> second_value;
    std::string second_unit, precision;
    double time_step_s = 0.0;
    int steps = 0;
    std::string outcome;
    std::optional<int> recovery_steps;
    std::optional<double> recovery_s;
    std::optional<int> iterations_until_reached;
    std::string undisturbed_at_rest;
    double largest_reach_diagonals = 0.0;
    std::optional<double> last_reach_diagonals, last_motion_diagonals, last_from_undisturbed_diagonals;
    int most_inverted_tets = 0;
    std::optional<int> last_inverted_tets;
    int steps_not_reached = 0;
    std::string as_published;
    double cpu_s = 0.0;
};
extern const analysis::Columns<CellRow> cell_columns;
CellRow cell_row(const MeasuredCell& measured);

// The shares of the cells as published by body, jiggle, factor and precision, each with the number of its cells; one row per quantity. The
// share of diverged cells has no interval: one cell refutes "unconditionally", and all cells are no sample. The shares of inverted cells,
// of cells in motion (bounded or inverted, and moving until the end) and of cells at rest have the 95 % interval of Clopper and Pearson,
// as if the cells were drawn at random from the settings between them.
analysis::CsvTable stability_measurements(const std::vector<MeasuredCell>& cells);

// The number of cells with each outcome, by body and model and on request by factor, as aligned columns.
std::string outcome_table(const std::vector<CellRow>& cells, bool by_factor);

// The text states why the map is unreliable: an outcome that occurs in no cell, or a cell in which the printed sign does not
// diverge. Empty where there is no such defect.
std::string blind_spots(const std::vector<CellRow>& cells);

// The cells of a map, one row each, with both values and the outcome.
analysis::CsvTable map_csv(const std::vector<CellRow>& cells, const std::string& factor, const std::string& second_factor);

// Does a deformer that minimises an energy find its own result again from a broken initial shape, and after how many iterations?
//   for (const StabilityCell& cell : start_cells(full)) rows.push_back(run_broken_start(cell, most_iterations));
// The deformer runs from the broken shape with 1, 2, 4, ... iterations, up to the most, and once with the most from its own initial guess.
// The result of the latter is its own result. These runs differ from a scene only in the initial shape and in the number of iterations.
// The outcomes in cells.csv cannot show this: there a deformer without memory forgets a broken shape after one step.

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

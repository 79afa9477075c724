// What the cells of a run came to, as records: cells.csv, the shares that C08 is judged by, and tables for people.
#pragma once

#include "analysis/records/typed_table.hpp"
#include "experiments/studies/stability/cell_run.hpp"

#include <string>
#include <vector>

namespace experiments {

struct MeasuredCell {
    StabilityCell cell;
    CellResult result;
};

// cells.csv: a cell and what became of it.
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

// Of the cells as published: shares by body, jiggle, factor and precision, each with the number of its cells. One row a quantity. The
// share that ran away is the cells' own, without an interval: "unconditionally" is refuted by one cell, and what was found in all of them
// is no sample. Inverted, not at rest (bounded or inverted, and moving to the end) and converged have 95 % of Clopper and Pearson, as if
// the cells were drawn at random from the settings between them.
analysis::CsvTable stability_measurements(const std::vector<MeasuredCell>& cells);

// Counts of each outcome by body and model, or by factor too, aligned.
std::string outcome_table(const std::vector<CellRow>& cells, bool by_factor);

// What makes the map worth reading: each outcome occurs in it, and the sign as printed runs away in every cell. Empty, or what is missing.
std::string blind_spots(const std::vector<CellRow>& cells);

// The cells of a map, a row each: both values and the outcome.
analysis::CsvTable map_csv(const std::vector<CellRow>& cells, const std::string& factor, const std::string& second_factor);

}  // namespace experiments

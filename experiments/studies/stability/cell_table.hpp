// The outcomes of a run's cells as records: cells.csv, the shares by which C08 is judged, and tables for reading.
#pragma once

#include "analysis/records/tables.hpp"
#include "experiments/studies/stability/cell_run.hpp"

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

}  // namespace experiments

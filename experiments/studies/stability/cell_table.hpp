// What the cells of a run came to, as records: cells.csv, the shares that C08 is judged by, and tables for people.
#pragma once

#include "analysis/records/csv_table.hpp"
#include "experiments/studies/stability/cell_run.hpp"

#include <string>
#include <vector>

namespace experiments {

struct MeasuredCell {
    StabilityCell cell;
    CellResult result;
};

analysis::CsvTable cells_csv(const std::vector<MeasuredCell>& cells);

// Of the cells as published: shares by body, jiggle, factor and precision, each with the number of its cells. One row a quantity. The
// share that ran away is the cells' own, without an interval: "unconditionally" is refuted by one cell, and what was found in all of them
// is no sample. Inverted, not at rest (bounded or inverted, and moving to the end) and converged have 95 % of Clopper and Pearson, as if
// the cells were drawn at random from the settings between them.
analysis::CsvTable stability_measurements(const std::vector<MeasuredCell>& cells);

// Counts of each outcome by body and model, or by factor too, aligned; of one or more cells.csv.
std::string outcome_table(const std::vector<analysis::CsvTable>& cells, bool by_factor);

// What makes the map worth reading: each outcome occurs in it, and the sign as printed runs away in every cell. Empty, or what is missing.
std::string blind_spots(const std::vector<analysis::CsvTable>& cells);

// The cells of a map, a row each: both values and the outcome.
analysis::CsvTable map_csv(const std::vector<analysis::CsvTable>& cells, const std::string& factor, const std::string& second_factor);

}  // namespace experiments

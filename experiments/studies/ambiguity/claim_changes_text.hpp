// The table of claim_changes.hpp for people, at most 120 columns wide: a body a block, a reading a line, a claim a column.
//   fmt::print("{}", claim_changes_text(table));
// A cell is B over A of the figure whose verdict flips, or else of the one that changes most. Below, by which readings each claim flips,
// and why others cannot touch it.
#pragma once

#include "analysis/records/csv_table.hpp"

#include <string>

namespace experiments {

std::string claim_changes_text(const analysis::CsvTable& table);

}  // namespace experiments

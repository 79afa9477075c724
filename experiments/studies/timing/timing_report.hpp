// What the timing study tells of its records: a page beside Table 1, and a short table for the terminal, each with the size up to which the
// ladder of sizes is real time.
//   const analysis::CsvTable table = analysis::read_csv("timing.csv");  timing_text(table)
#pragma once

#include "analysis/records/csv_table.hpp"

#include <string>

namespace experiments {

// Of timing_table's rows, of all meshes put together.
std::string timing_markdown(const analysis::CsvTable& table);
std::string timing_text(const analysis::CsvTable& table);

}  // namespace experiments

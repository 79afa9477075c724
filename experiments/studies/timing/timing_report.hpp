// What the timing study tells of its records: a page beside Table 1, and a short table for the terminal, each with the size up to which the
// ladder of sizes is real time.
//   const analysis::CsvTable table = analysis::read_csv("timing.csv");  timing_text(table)
#pragma once

#include "analysis/records/csv_table.hpp"

#include <string>
#include <vector>

namespace experiments {

// Of timing_table's rows, of all meshes put together.
std::string timing_markdown(const analysis::CsvTable& table);
std::string timing_text(const analysis::CsvTable& table);

// Vertices at which a frame takes 1 / 30 s, on the straight line through log total over log vertices between the two sizes around it, or
// beyond the last two; with the exponent over all sizes.
struct RealTimeEnd {
    double vertices = 0.0;
    bool beyond = false;  // all sizes measured are quicker, or all slower
    double exponent = 0.0;
};
RealTimeEnd real_time_end(const std::vector<double>& vertices, const std::vector<double>& total_ms);  // two sizes or more, in any order

}  // namespace experiments

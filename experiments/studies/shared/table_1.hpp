// Table 1 of the paper and what follows from its own numbers: counts against the topology of tet meshes, times against each other.
#pragma once

#include "analysis/verdicts/case_record.hpp"

#include <array>
#include <string>
#include <vector>

namespace experiments {

struct TableOneRow {
    std::string model;
    int vertices, stretch, tets, bind;
    double stretch_ms, volume_ms, total_ms;  // "CT", for a simulation of 1 s
    double jiggling, frames_per_s;
};
const std::array<TableOneRow, 5>& table_1();

// C13: "roughly 2K vertices and 10K tetrahedral elements" (Sec. 4) against the counts of Table 1.
std::vector<analysis::PrintedValue> mesh_size_values();

// C14. A tet mesh of a ball-like body has V - E + F - T = 1 and F = 2T + Fb/2, so E = V + T + Fb/2 - 1 with at least four boundary
// triangles; handles, voids and pinches raise E. Every vertex has one bind constraint. A total is no less than its parts. One second has
// a hundred steps of 10 ms, each of which is a frame, so the printed frame rate gives the time of a second.
std::vector<analysis::PrintedValue> table_1_values();

}  // namespace experiments

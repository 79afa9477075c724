// The paper against itself: its mesh sizes (C13), its Table 1 (C14), and Eq. 12-20 as the gradients and corrections of
// Eq. 11 (C15).
//   for (const analysis::PrintedValue& value : table_1_values()) value.is_consistent()
#pragma once

#include "analysis/verdicts/case_record.hpp"
#include "experiments/studies/shared/bodies.hpp"

#include <array>
#include <vector>

namespace experiments {

// C13: "roughly 2K vertices and 10K tetrahedral elements" (Sec. 4) against the means of Table 1, of which each may
// differ by a quarter.
std::vector<analysis::PrintedValue> mesh_size_values(const std::array<TableOneRow, 5>& table = table_1());

// C14. A tet mesh of a ball-like body has V - E + F - T = 1 and F = 2T + Fb/2, so E = V + T + Fb/2 - 1 with at least
// four boundary triangles; handles, voids and pinches raise E. Every vertex has one bind constraint. A total is no less
// than its parts. One second has a hundred steps of 10 ms, each of which is a frame, so the printed frame rate gives
// the time of a second.
std::vector<analysis::PrintedValue> table_1_values();

// C15, on seeded random tets away from the origin. Gradients: the largest |printed - difference quotient| / |difference
// quotient| over the tets, by central differences of Eq. 11. It may be as large as the rounding of the quotient.
// Corrections: the largest |C after| / |C before| when Eq. 17-21 are applied with k = 1. A correction does not make C
// larger.
std::vector<analysis::PrintedValue> equation_values(int tets = 200, unsigned seed = 1);

}  // namespace experiments

// C15: are Eq. 12-20 the gradients and corrections of Eq. 11? On seeded random tets away from the origin, each printed gradient is compared
// with central differences of Eq. 11, and each printed correction with its purpose, which is to reduce C.
#pragma once

#include "analysis/verdicts/case_record.hpp"

#include <vector>

namespace experiments {

// Gradients: the largest |printed - difference quotient| / |difference quotient| over the tets. It may be as large as the rounding of the
// quotient. Corrections: the largest |C after| / |C before| when Eq. 17-21 are applied with k = 1. A correction does not make C larger.
std::vector<analysis::PrintedValue> equation_values(int tets = 200, unsigned seed = 1);

}  // namespace experiments

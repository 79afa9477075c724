// C15: are Eq. 12-20 the gradients and corrections of Eq. 11? Each as printed, on seeded random tets away from the origin, beside central
// differences of Eq. 11 and beside what a correction is for.
#pragma once

#include "analysis/case_record.hpp"

#include <vector>

namespace experiments {

// Gradients: largest of |printed - difference quotient| / |difference quotient| over the tets; it holds up to the rounding of the quotient.
// Corrections: largest of |C after| / |C before| when Eq. 17-21 are applied with k = 1; a correction does not make C larger.
std::vector<analysis::PrintedFigure> equation_figures(int tets = 200, unsigned seed = 1);

}  // namespace experiments

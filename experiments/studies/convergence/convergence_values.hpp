// The values by which C03 and C12 are judged, from the paths of a case. The default setting on the scene's own mesh gives the value, and
// the other orders, precisions and meshes of about that size give its interval. Where a tolerance is never reached, the number of
// iterations that were tried takes its place and `limit` marks it, so that a ratio is a bound. Where neither initial guess reaches the
// tolerance there is no value; where this happens in another order or on another mesh, the interval is open. The share of such cases is a
// value of its own. Only characters are judged. The limb is measured for comparison, as are twists, in which the rest pose already
// satisfies all constraints.
#pragma once

#include "analysis/verdicts/case_record.hpp"
#include "experiments/studies/convergence/convergence_case.hpp"

namespace experiments {

std::vector<analysis::Measurement> convergence_values(const ConvergenceResult& result);

}  // namespace experiments

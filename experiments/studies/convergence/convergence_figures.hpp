// The figures that C03 and C12 are judged by, from the paths of a case; the default setting on the scene's own mesh gives the value, the
// other orders, precisions and meshes of about that size its interval. Where a tolerance is never reached, the number of iterations that
// were tried stands for it and `of` says so: a ratio is then a bound. Where neither start reaches it there is no figure, and where that is
// so in another order or mesh the interval is open; how often it is so is a figure of its own. Characters are judged; the limb is beside
// them, and so are twists, in which the rest pose has nothing to do.
#pragma once

#include "analysis/case_record.hpp"
#include "experiments/studies/convergence/convergence_case.hpp"

namespace experiments {

std::vector<analysis::Measurement> convergence_figures(const ConvergenceResult& result);

}  // namespace experiments

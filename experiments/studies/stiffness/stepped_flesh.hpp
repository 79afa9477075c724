// The same flesh with the solvers as they are, step by step until it hangs still: the linear map's second opinion, and what large
// displacements change.
//   const SteppedFlesh still = step_until_still(flesh, setting, 9.81);
#pragma once

#include "experiments/studies/stiffness/stiffness_setting.hpp"

namespace experiments {

struct SteppedFlesh {
    pbs::Positions displacement;  // [m], #V x 3, under the gravity asked for
    bool converged = false;       // the mean displacement moved by less than 1e-6 of itself for 25 steps
    int steps = 0;
};
SteppedFlesh step_until_still(const LoadedFlesh& flesh, const StiffnessSetting& setting, double gravity_m_s2, int most_steps = 4000);

}  // namespace experiments

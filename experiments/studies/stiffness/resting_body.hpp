// Where a loaded body comes to rest, in two ways: by the linear map of a step near rest, and by the solvers as they are.
//   const RestingState rest = rest_near_rest(body, {.method = Method::pbs, .k_stretch = 0.2, .iterations = 24, .time_step_s = 0.01});
//   effective_stiffness_n_m(body, rest.displacement, 1.0);
#pragma once

#include "experiments/studies/shared/near_rest/step_near_rest.hpp"
#include "experiments/studies/stiffness/stiffness_setting.hpp"

namespace experiments {

// Under 1 m/s^2; the displacement is that after the step, with what the zone carries along outside of it.
RestingState rest_near_rest(const LoadedBody& body, const StiffnessSetting& setting);

// Step by step until the body hangs still, under the gravity asked for: the linear map's second opinion, and what large displacements
// change.
struct SteppedBody {
    pbs::Positions displacement;  // [m], #V x 3
    bool converged = false;       // the mean displacement moved by less than 1e-6 of itself for 25 steps
    int steps = 0;
};
SteppedBody step_until_still(const LoadedBody& body, const StiffnessSetting& setting, double gravity_m_s2, int most_steps = 4000);

}  // namespace experiments

// How a body moves in time.
#pragma once

namespace reference_fem {

// The schemes in time are those of dynamics/time_scheme.hpp.
enum class Dynamics {
    quasi_static,       // equilibrium in every pose
    newmark,            // average acceleration: beta 1/4, gamma 1/2
    generalized_alpha,  // J. Chung, G. Hulbert, J. Appl. Mech. 60, 1993
};

}  // namespace reference_fem

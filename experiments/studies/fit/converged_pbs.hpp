// The paper's constraints iterated until nothing moves any more: what is left of the solver's own error then is nothing, and what differs
// from the finite elements is the model.
//   const ConvergedPbs limit = converge(character, pose, options);
#pragma once

#include "pbs/character/character.hpp"
#include "pbs/solver/options.hpp"

namespace experiments {

struct ConvergedPbs {
    pbs::Positions positions;  // [m], #V x 3
    int iterations = 0;
    double last_change_m = 0.0;  // largest |x - x_before| over the last hundred iterations
    bool converged = false;
};

// In double, from LBS on; stops when a hundred iterations move no vertex by more than 1e-6 of the bounding diagonal.
ConvergedPbs converge(const pbs::Character& character, const pbs::Pose& pose, pbs::PbsOptions options, int most_iterations = 20000);

// options.iterations of them, from LBS.
pbs::Positions after_iterations(const pbs::Character& character, const pbs::Pose& pose, const pbs::PbsOptions& options);

}  // namespace experiments

// The time of a Newton step of the reference's nonlinear elements: stable neo-Hookean, linear tets, bones held by smooth springs.
//   const NewtonTiming timing = time_newton(body, rounds);
// Processor time of one thread, to which the BLAS is limited. The reference has no plain implementation, so there is no ratio.
#pragma once

#include "experiments/studies/bench/bench_body.hpp"
#include "experiments/studies/shared/timed_rounds.hpp"

#include <string>

namespace experiments {

struct NewtonTiming {
    std::string model;        // stable_neo_hookean
    int steps = 0;            // Newton steps from rest to the pose of the body
    Spread ms_frame;          // those steps, without the set-up and the analysis of the matrix's pattern
    Spread ms_step;           // assembly, factorisation, solve and line search
    Spread ns_element;        // of a step
    bool is_reached = false;  // the residual came within tolerance
};

// pbs::InputError where the build has no reference, or a bone of the body cannot be held.
NewtonTiming time_newton(const BenchBody& body, const Rounds& rounds);

}  // namespace experiments

// How long the reference takes: linear elasticity on the same tets (P1, bones embedded), the first frame with all its set-up and every
// further one. One thread's processor time; the BLAS is held to one.
#pragma once

#include "experiments/studies/bench/bench_body.hpp"
#include "experiments/studies/shared/timed_rounds.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace experiments {

struct FemTiming {
    std::string model = "linear";
    int element_order = 1;
    Spread ms_first_solve;    // elements, stiffness, elimination, symbolic analysis, factor, solve
    Spread ms_further_frame;  // loads of another pose, and a solve
    double further_to_first = 0.0;
};

// pbs::InputError where the build has no reference, or a bone of the body cannot be gripped.
FemTiming time_fem(const BenchBody& body, const Rounds& rounds);

nlohmann::json fem_json(const FemTiming& timing, double plain_step_ms);

}  // namespace experiments

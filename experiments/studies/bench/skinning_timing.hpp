// How long LBS and DQS take: the blends as the paper's Eq. 1 reads (`plain`), and packed for many poses of one body (`packed`), by turns,
// one thread's processor time.
//   for (const SkinningTiming& timing : time_skinning(body, limits, rounds)) ...
#pragma once

#include "experiments/studies/bench/bench_body.hpp"
#include "experiments/studies/bench/machine_limits.hpp"
#include "experiments/studies/shared/timed_rounds.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace experiments {

struct SkinningTiming {
    std::string blend;      // lbs, dqs
    std::string variant;    // plain, packed
    std::string precision;  // f32, f64
    Spread ns_vertex;
    Spread ratio_to_plain;        // plain is in f64
    double gb_s = 0.0;            // rest positions in, posed positions out: what a blend must move at least
    double share_of_limit = 0.0;  // of the copy bandwidth at that working set
};

std::vector<SkinningTiming> time_skinning(const BenchBody& body, const MachineLimits& limits, const Rounds& rounds);

void to_json(nlohmann::json& json, const SkinningTiming& timing);

}  // namespace experiments

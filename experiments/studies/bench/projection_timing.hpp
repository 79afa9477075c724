// How long the projections take: every order, precision and number of threads on one body, by turns.
//   for (const ProjectionTiming& timing : time_projections(body, {1, 2}, limits, rounds)) ...
// A step is 24 iterations over all constraints, without the way of positions into and out of an order's own layout, which is told beside
// it. One thread: processor time of that thread. Several: wall time.
#pragma once

#include "experiments/studies/bench/bench_body.hpp"
#include "experiments/studies/bench/machine_limits.hpp"
#include "experiments/studies/bench/projection_work.hpp"
#include "experiments/studies/shared/timed_rounds.hpp"
#include "pbs/solver/step_summary.hpp"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <vector>

namespace experiments {

inline constexpr int iterations_a_step = 24;

// How near one thread of a class comes to what the machine allows.
struct RooflinePoint {
    double flops_a_byte = 0.0;
    double gflops = 0.0;             // useful ones, reached
    double attainable_gflops = 0.0;  // min(peak, bandwidth where the working set lives times flops_a_byte)
    double share_of_limit = 0.0;
};

struct ClassTiming {
    Spread ns;                              // a constraint (and pose)
    std::optional<RooflinePoint> roofline;  // of one thread
};

struct ProjectionTiming {
    std::string variant, precision;
    int threads = 1, poses = 1;
    ClassTiming stretch, volume, bind;
    Spread ms_step;                  // a pose
    std::optional<double> ms_floor;  // a pose, of one thread: what an iteration has to move over the bandwidth at its working set
    double ms_transfer = 0.0;        // load and store, median
    Spread ratio_to_plain, ratio_to_plain_native, ratio_to_plain_spread;  // of times of the same round; same precision
    std::optional<double> best_speedup_by_threads;                        // of the quickest rounds, which other work disturbed least
    std::optional<Spread> speedup_by_threads;                             // of wall times over one thread's
    double working_set_bytes = 0.0;
    pbs::Residuals residuals;  // after the step
    std::optional<double> stretch_fill, volume_fill;

    bool is_yardstick() const { return variant == "plain_native" || variant == "plain_spread"; }  // of the bench alone
};

std::vector<ProjectionTiming> time_projections(const BenchBody& body, const std::vector<int>& threads, const MachineLimits& limits,
                                               const Rounds& rounds);

void to_json(nlohmann::json& json, const ProjectionTiming& timing);

}  // namespace experiments

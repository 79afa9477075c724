// How long the projections take: every order, precision and number of threads on one body, in turns.
//   for (const ProjectionTiming& timing : time_projections(body, {1, 2}, limits, rounds)) ...
// A step is 24 iterations over all constraints. The transfer of positions into an order's own layout and back is reported separately. One
// thread is measured in its processor time, several threads in wall time.
#pragma once

#include "experiments/studies/bench/machine_limits.hpp"
#include "experiments/studies/bench/step_loops.hpp"
#include "experiments/studies/shared/timed_rounds.hpp"
#include "pbs/solver/batched/batched_projection.hpp"

#include <optional>
#include <string>
#include <vector>

namespace experiments {

inline constexpr int iterations_per_step = 24;

// The answer after the step over that of plain loops after theirs, on the same body and in the same precision; above 1: a loss.
struct AnswerRatio {
    double residual = 0.0;    // combined: sqrt((stretch_rms^2 + volume_rms^2 + (bind_rms / mean rest distance to the bone)^2) / 3)
    double volume_rms = 0.0;  // rms of V / V0 - 1
};
AnswerRatio answer_ratio(const pbs::Residuals& own, const pbs::Residuals& plain, double mean_distance_m);

struct ProjectionTiming : ProjectionKind {
    int poses = 1;
    Spread stretch, volume, bind;    // ns per constraint and pose
    Spread ms_step;                  // per pose
    std::optional<double> ms_floor;  // per pose, for one thread: the bytes that a step has to move, over the bandwidth at its working set
    double ms_transfer = 0.0;        // load and store, median
    Spread ratio_to_plain, ratio_to_plain_native, ratio_to_plain_spread;  // ratios within a round, at the same precision
    std::optional<double> best_speedup_by_threads;                        // ratio of the fastest rounds, which were disturbed least
    std::optional<Spread> speedup_by_threads;                             // wall time of one thread over this one's
    double working_set_bytes = 0.0;
    pbs::Residuals residuals;                             // after the step
    AnswerRatio answer_to_plain, answer_to_plain_spread;  // above 1: the order, which has a limit of its own, is farther from its goals
    std::optional<double> stretch_fill, volume_fill;

    bool is_baseline() const { return variant == "plain_native" || variant == "plain_spread"; }  // which no scene can ask for
};

std::vector<ProjectionTiming> time_projections(const BenchBody& body, const std::vector<int>& threads, const MachineLimits& limits,
                                               const Rounds& rounds);

}  // namespace experiments

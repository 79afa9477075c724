// What is told of a path of iterations: when it is there, how fast it went, where it stalled. The constraints contradict each other, so a
// residual does not go to zero; "there" needs one of two tolerances:
// - residual: the combined residual (Look::combined) within 5 % of its floor, the lowest that any of the starts has after the last
//   iteration; or below 1e-4, where the constraints can be satisfied and the floor is rounding (no constraint feels a twist);
// - volume: the absolute volume change within the paper's 0.5 %;
// and the path is there from the iteration on after which it never leaves it again.
//   const double floor = floor_of(paths);
//   Reached reached = reached_residual(paths[0], floor);   // reached.iterations, or more than those where !reached.within
#pragma once

#include "analysis/bootstrap.hpp"
#include "experiments/studies/shared/iteration_path.hpp"

#include <optional>

namespace experiments {

inline constexpr double residual_tolerance = 0.05;  // of the floor
inline constexpr double satisfied_residual = 1e-4;
inline constexpr double volume_tolerance_pct = 0.5;  // Sec. 4

struct Reached {
    int iterations = 0;
    bool within = false;  // false: not after so many
};

double floor_of(const std::vector<IterationPath>& paths);  // of those that stayed finite; not a number where none did
Reached reached_residual(const IterationPath& path, double floor);
Reached reached_volume(const IterationPath& path);

// residual_n = floor + c rate^n up to where it stalls for good, within 5 % of its own last residual. A residual that the second half of the
// iterations changes by more than 1 % has not stalled: then floor is that of all starts, and the fit goes to the end. No rate where the
// last residual is rounding.
struct Rate {
    std::optional<int> stalls_at;
    analysis::Interval rate;   // least squares of log(residual_n - floor); its points are no independent sample, so it is too narrow
    double log_rms_off = 0.0;  // how far the residual is from one rate, rms of the logarithm
};
Rate rate_of(const IterationPath& path, double floor);

const Look& look_at(const IterationPath& path, int iteration);  // the last one not after it
const Look& nearest_to_reference(const IterationPath& path);    // of the least error_joint_pct

}  // namespace experiments

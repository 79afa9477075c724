// What is told of a path of iterations: when it is there, how fast it went, where it stalled. The constraints contradict each other, so a
// residual does not go to zero; "there" needs one of two tolerances:
//   residual  the combined residual (Look::combined) within 5 % of its floor: the lowest that any of the starts has after the last
//   iteration volume    the absolute volume change within the paper's 0.5 %
// and the path is there from the iteration on after which it never leaves it again.
//   const double floor = floor_of(paths);
//   Reached reached = reached_residual(paths[0], floor);   // reached.iterations, or more than those where !reached.within
#pragma once

#include "analysis/bootstrap.hpp"
#include "experiments/convergence/iteration_path.hpp"

namespace experiments {

inline constexpr double residual_tolerance = 0.05;   // of the floor
inline constexpr double volume_tolerance_pct = 0.5;  // Sec. 4

struct Reached {
    int iterations = 0;
    bool within = false;  // false: not after so many
};

double floor_of(const std::vector<IterationPath>& paths);  // of those that stayed finite; not a number where none did
Reached reached_residual(const IterationPath& path, double floor);
Reached reached_volume(const IterationPath& path);

// residual_n = own floor + c rate^n up to where it stalls: within 5 % of the path's own last residual for good.
struct Rate {
    int stalls_at = 0;
    analysis::Interval rate;  // least squares of log(residual_n - own floor); its points are no independent sample, so it is too narrow
};
Rate rate_of(const IterationPath& path);

const Look& look_at(const IterationPath& path, int iteration);  // the last one not after it
const Look& nearest_to_reference(const IterationPath& path);    // of the least error_joint_pct

}  // namespace experiments

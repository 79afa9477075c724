// Paths of iterations defined by formulas, in the form in which a convergence study measures them.
#pragma once

#include "experiments/studies/convergence/convergence_case.hpp"

#include <cmath>
#include <functional>

namespace test_support {

// Records every iteration; figure(n) is the combined residual, the absolute volume change [%] and the error [%] at
// once.
inline experiments::IterationPath path_by(int most, const std::function<double(int)>& value)
{
    experiments::IterationPath path;
    for (int n = 0; n <= most; ++n) {
        experiments::Look look;
        look.iteration = n;
        look.combined = look.volume_abs_change_pct = look.error_joint_pct = value(n);
        path.looks.push_back(look);
    }
    return path;
}

// Starts at `above` its floor and keeps a share `rate` of the excess in each iteration.
inline experiments::IterationPath path_to_floor(int most, double floor, double above, double rate)
{
    return path_by(most, [=](int n) { return floor + above * std::pow(rate, n); });
}

// A character whose initial guesses converge to the floor 1 at the given rates, LBS first, by default in the order
// `ordered` and f32.
inline experiments::ConvergencePaths starts_at_rates(int vertices, const std::vector<double>& rates, int most = 1000)
{
    experiments::ConvergencePaths paths;
    paths.of.body = "human";
    paths.of.pose = "01_01 crouch";
    paths.character = true;
    paths.of.vertices = vertices;
    paths.of.order = "ordered", paths.of.precision = "f32";
    paths.of.k_stretch = 0.2;
    for (const double rate : rates) paths.paths.push_back(path_to_floor(most, 1.0, 1.0, rate));
    return paths;
}

// The same in the paper's order and precision, with the controls: LBS once more, and random positions that never
// converge.
inline experiments::ConvergencePaths papers_paths(const std::vector<double>& rates)
{
    experiments::ConvergencePaths paths = starts_at_rates(1780, rates);
    paths.of.order = "plain", paths.of.precision = "f64";
    paths.controls = {paths.paths.front(), path_to_floor(1000, 2.0, 1.0, 0.99)};
    return paths;
}

// Returns the values that the study measures on these paths.
inline std::vector<analysis::Measurement> values_of_paths(const std::vector<experiments::ConvergencePaths>& paths,
                                                          bool ladder = false)
{
    return experiments::convergence_values(experiments::rate_rows({paths, ladder}), ladder);
}

}  // namespace test_support

// How far rounding may move the positions of a step of Algorithm 1, for tolerances. Each projection rounds the positions of its vertices
// and a correction, in some ten or sixteen roundings (projection_rounding.hpp). n roundings of either sign add up to at most 6 sqrt n of
// them, except in one of some 10,000 cases (N. Higham, T. Mary, A new approach to probabilistic rounding error analysis, SIAM J. Sci.
// Comput. 41, 2019, Sec. 2). The projections that follow multiply them by at most the condition number of the step.
#pragma once

#include "pbs/solver/constraint_set.hpp"
#include "pbs/solver/pbs_solver.hpp"
#include "tests/support/projection_rounding.hpp"
#include "tests/support/random_points.hpp"
#include "tests/support/two_bone_limb.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace test_support {

// The largest change of a coordinate over that of a coordinate of the blend, 1e-8 m at random, in double precision.
inline double step_condition(const TwoBoneLimb& limb, pbs::PbsOptions options)
{
    options.precision = pbs::Precision::f64;
    constexpr double size_m = 1e-8;
    RandomPoints random(71);
    pbs::Positions moved = limb.lbs;
    for (Eigen::Index v = 0; v < moved.rows(); ++v) moved.row(v) += random.point(size_m).transpose();
    pbs::PbsSolver solver(limb.mesh, limb.binding.distance, {}, options), disturbed(limb.mesh, limb.binding.distance, {}, options);
    solver.advance(limb.lbs, limb.bind_points, 0.01);
    disturbed.advance(moved, limb.bind_points, 0.01);
    return std::max(1.0, (disturbed.positions() - solver.positions()).cwiseAbs().maxCoeff() / size_m);
}

// The root of the sum of squares of the roundings [m] of a projection whose correction goes through so many.
inline double probable_rounding_m(const RoundingBound& bound, double roundings, const pbs::Vec3& p)
{
    const double of_position = std::numeric_limits<double>::epsilon() * p.cwiseAbs().maxCoeff();
    return std::hypot(of_position, (bound.step - of_position) / std::sqrt(roundings));
}

// The same over all projections in one iteration, at the vertex where it is largest.
inline double iteration_rounding_m(const TwoBoneLimb& limb, const pbs::PbsOptions& options)
{
    const auto set = pbs::make_constraint_set<double>(limb.mesh, limb.binding.distance, {}, options);
    const auto& w = set.inverse_mass;
    const auto p = [&](int vertex) -> pbs::Vec3 { return limb.lbs.row(vertex); };
    std::vector<double> squares(w.size(), 0.0);
    for (const auto& c : set.bind)
        squares[c.vertex] +=
            std::pow(probable_rounding_m(rounding_of<double>(c, limb.bind_points.row(c.vertex), p(c.vertex)), 10, p(c.vertex)), 2);
    for (const auto& c : set.stretch) {
        const auto [i, j] = c.vertex;
        const RoundingBound bound = rounding_of<double>(c, w[i], w[j], p(i), p(j));
        for (const int vertex : c.vertex) squares[vertex] += std::pow(probable_rounding_m(bound, 10, p(vertex)), 2);
    }
    for (const auto& c : set.volume) {
        const auto [i, j, k, l] = c.vertex;
        const RoundingBound bound = rounding_of<double>(c, {w[i], w[j], w[k], w[l]}, {p(i), p(j), p(k), p(l)});
        for (const int vertex : c.vertex) squares[vertex] += std::pow(probable_rounding_m(bound, 16, p(vertex)), 2);
    }
    return std::sqrt(*std::max_element(squares.begin(), squares.end()));
}

// In the precision of the options [m], for coordinates as large as those of the limb.
inline double step_rounding_m(const TwoBoneLimb& limb, const pbs::PbsOptions& options)
{
    const bool f32 = options.precision == pbs::Precision::f32;
    const double eps = f32 ? std::numeric_limits<float>::epsilon() : std::numeric_limits<double>::epsilon();
    return 6.0 * std::sqrt(options.iterations) * iteration_rounding_m(limb, options) * eps / std::numeric_limits<double>::epsilon() *
           step_condition(limb, options);
}

}  // namespace test_support

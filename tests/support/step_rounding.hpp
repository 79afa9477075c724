// How far rounding may move the positions of a step of Algorithm 1 or of XPBD, for tolerances. Each projection rounds
// the positions of its vertices and a correction, in some ten or sixteen roundings (projection_rounding.hpp). n
// roundings of either sign add up to at most 6 sqrt n of them, except in one of some 10,000 cases (N. Higham, T. Mary,
// A new approach to probabilistic rounding error analysis, SIAM J. Sci. Comput. 41, 2019, Sec. 2). The projections that
// follow multiply them by a factor that random disturbances of the blend measure.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/solver/constraint_set.hpp"
#include "pbs/solver/pbs_solver.hpp"
#include "pbs/solver/xpbd_solver.hpp"
#include "tests/support/projection_rounding.hpp"
#include "tests/support/random_points.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/two_bone_limb.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace test_support {

template <typename Options>
using SolverOf = std::conditional_t<std::is_same_v<Options, pbs::PbsOptions>, pbs::PbsSolver, pbs::XpbdSolver>;

struct Stepped {
    pbs::StepSummary summary;
    pbs::Positions positions;
};

// One step of PBS or XPBD, by the kind of the options.
template <typename Options>
Stepped stepped(const TwoBoneLimb& limb, const Options& options, const std::vector<bool>& held = {})
{
    SolverOf<Options> solver(limb.mesh, limb.binding.distance, {}, options, held);
    const pbs::StepSummary summary = solver.advance(limb.lbs, limb.bind_points, 0.01);
    return {summary, solver.positions()};
}

// The limb with other positions in place of the blend's.
inline TwoBoneLimb blended_to(TwoBoneLimb limb, const pbs::Positions& lbs)
{
    limb.lbs = lbs;
    return limb;
}

// The largest standard deviation of a coordinate after the step, over that of the coordinates of the blend, or one
// where the step damps disturbances: the last roundings are not damped. Disturbances have the standard deviation size_m
// / sqrt 3. The largest of sixteen normally distributed changes is less than their standard deviation with a
// probability of 0.683^16 = 0.2 %, in one coordinate, and there are thousands. In double precision, where rounding is
// 1e-8 of a disturbance.
template <typename Options>
double step_condition(const TwoBoneLimb& limb, Options options)
{
    options.precision = pbs::Precision::f64;
    constexpr double size_m = 1e-8;
    const pbs::Positions undisturbed = stepped(limb, options).positions;
    RandomPoints random(71);
    double largest_m = 0.0;
    for (int draw = 0; draw < 16; ++draw) {
        pbs::Positions moved = limb.lbs;
        for (Eigen::Index v = 0; v < moved.rows(); ++v) moved.row(v) += random.point(size_m).transpose();
        largest_m = std::max(largest_m,
                             (stepped(blended_to(limb, moved), options).positions - undisturbed).cwiseAbs().maxCoeff());
    }
    return std::max(1.0, largest_m / (size_m / std::sqrt(3.0)));
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
        squares[c.vertex] += std::pow(
            probable_rounding_m(rounding_of<double>(c, limb.bind_points.row(c.vertex), p(c.vertex)), 10, p(c.vertex)),
            2);
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

// The root of the sum of squares over all iterations, in the precision of the options [m], before it is multiplied by
// later projections.
inline double added_rounding_m(const TwoBoneLimb& limb, const pbs::PbsOptions& options)
{
    const bool f32 = options.precision == pbs::Precision::f32;
    const double eps = f32 ? std::numeric_limits<float>::epsilon() : std::numeric_limits<double>::epsilon();
    return std::sqrt(options.iterations) * iteration_rounding_m(limb, options) * eps /
           std::numeric_limits<double>::epsilon();
}

// In the precision of the options [m], for coordinates as large as those of the limb.
inline double step_rounding_m(const TwoBoneLimb& limb, const pbs::PbsOptions& options)
{
    return 6.0 * added_rounding_m(limb, options) * step_condition(limb, options);
}

// The same of XPBD, between two evaluations. The roundings of a projection are at most those of a PBS projection of
// stiffness 1, because a compliance makes the correction smaller, and as many again for the term of the multiplier,
// which balances C.
inline double step_rounding_m(const TwoBoneLimb& limb, const pbs::XpbdOptions& options)
{
    pbs::PbsOptions rigid;
    rigid.k_stretch = rigid.k_volume = rigid.k_bind = 1.0;
    rigid.masses = pbs::Masses::lumped;
    rigid.iterations = options.iterations * options.substeps;
    rigid.precision = options.precision;
    return 2.0 * 2.0 * 6.0 * added_rounding_m(limb, rigid) * step_condition(limb, options);
}

struct ResidualRounding {
    double stretch_rms = 0.0, volume_rms = 0.0;
};

// How far the residuals of a step in float may be from those in double. Roundings move positions: random changes of the
// blend, whose standard deviation is that of the roundings if they are at most sqrt 3 times as large, measure what that
// changes. A residual itself goes through ten roundings: of a length, relative to it, and of products of three edges,
// relative to the volume at rest.
inline ResidualRounding residual_rounding(const TwoBoneLimb& limb, pbs::PbsOptions options,
                                          const std::vector<bool>& held = {})
{
    options.precision = pbs::Precision::f32;
    const double moved_m = std::sqrt(3.0) * added_rounding_m(limb, options);
    options.precision = pbs::Precision::f64;
    options.record_iterations = true;
    const auto change_of = [&](double pbs::Residuals::*residual) {
        return value_rounding(limb.lbs, moved_m, [&](const pbs::Positions& lbs) {
            return stepped(blended_to(limb, lbs), options, held).summary.history.back().*residual;
        });
    };
    const Eigen::VectorXd volumes = pbs::tet_volumes(limb.mesh.rest, limb.mesh.tets);
    double products =
        0.0;  // the sum of the magnitudes of the products of three edges of a blended tet, over six volumes at rest
    for (Eigen::Index t = 0; t < volumes.size(); ++t) {
        const auto corner = [&](int c) -> pbs::Vec3 { return limb.lbs.row(limb.mesh.tets(t, c)); };
        double longest = 0.0;
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < i; ++j) longest = std::max(longest, (corner(i) - corner(j)).norm());
        products = std::max(products, std::pow(std::sqrt(3.0) * longest, 3) / (6.0 * volumes(t)));
    }
    return {change_of(&pbs::Residuals::stretch_rms) + rounding_error_in<float>(10, 1.0),
            change_of(&pbs::Residuals::volume_rms) + rounding_error_in<float>(10, products)};
}

}  // namespace test_support

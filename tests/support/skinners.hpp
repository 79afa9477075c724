// The skinners, each called in the same way, and how far rounding may move their positions: for tests that hold for all
// of them.
//   const pbs::Positions posed = test_support::Delta<float, true>::applied(limb, limb.pose, {.iterations = 3});
//   const double error = test_support::Delta<float, true>::packed_error({.iterations = 3});
//   EXPECT_LT((posed - expected).rowwise().norm().maxCoeff(), error);
#pragma once

#include "pbs/geometry/topology.hpp"
#include "pbs/skinning/correctives.hpp"
#include "pbs/skinning/delta_mush.hpp"
#include "pbs/skinning/direct_delta_mush.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/two_bone_limb.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <vector>

namespace test_support {

using pbs::DeltaMushOptions;
using pbs::DirectDeltaMush;
using pbs::DirectDeltaMushOptions;
using pbs::MushSmoothing;
using pbs::Pose;
using pbs::Positions;
using pbs::Vec3;

// Mean positions of the neighbours, again and again, half-way: the default step.
inline Positions halfway_smoothed(const pbs::Adjacency& neighbours, Positions positions, int iterations)
{
    for (int iteration = 0; iteration < iterations; ++iteration) {
        const Positions last = positions;
        for (int i = 0; i < last.rows(); ++i) {
            const int count = neighbours.first[i + 1] - neighbours.first[i];
            positions.row(i) *= 0.5;
            for (int k = neighbours.first[i]; k < neighbours.first[i + 1]; ++k)
                positions.row(i) += 0.5 / count * last.row(neighbours.neighbour[k]);
        }
    }
    return positions;
}

// s_2 + sign(det) s_3 of a covariance, by how much its rotation stands out.
inline double rotation_gap(const Eigen::Matrix3d& covariance)
{
    const Vec3 s = Eigen::JacobiSVD<Eigen::Matrix3d>(covariance).singularValues();
    return s(1) + std::copysign(s(2), covariance.determinant());
}

// How far rounding may move a mushed position [m] of coordinates up to `farthest`, with the default step.
//   Smoothing: each mean of n neighbours goes through n + 4 roundings, and means do not amplify those before. Without a
//   motion, the blend and the rest shape are smoothed in the same roundings.
//   Rotation: the covariance is a sum of n products of smoothed edges, whose ends are in error by smoothing on both
//   sides, and its decomposition rounds some 30 times. An error E of the covariance turns its rotation by at most 2 |E|
//   / (s2 + s3), with s2 and s3 its smaller singular values, the last with the sign of its determinant (C. Kenney, A.
//   J. Laub, SIAM J. Matrix Anal. Appl. 12, 1991), which moves the vertex by that share of its detail. Sum: the detail,
//   its rotated coordinates and their sum go through six roundings.
template <class Scalar>
double mush_error(const pbs::TetMesh& mesh, const Positions& blended, bool moved, double farthest,
                  int iterations = DeltaMushOptions().iterations)
{
    const pbs::Adjacency neighbours = pbs::adjacency_of(mesh.tets, static_cast<int>(mesh.rest.rows()));
    const auto count = [&](int i) { return neighbours.first[i + 1] - neighbours.first[i]; };
    const Positions rest = halfway_smoothed(neighbours, mesh.rest, iterations),
                    posed = halfway_smoothed(neighbours, blended, iterations);
    int most = 0;
    for (int i = 0; i < rest.rows(); ++i) most = std::max(most, count(i));
    const double of_smoothing =
        moved ? std::sqrt(3.0) * rounding_error_in<Scalar>(iterations * (most + 4), farthest) : 0.0;
    double largest = 0.0;
    for (int i = 0; i < rest.rows(); ++i) {
        Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
        double magnitude = 0.0, lengths = 0.0;
        for (int k = neighbours.first[i]; k < neighbours.first[i + 1]; ++k) {
            const int j = neighbours.neighbour[k];
            const Eigen::RowVector3d to = posed.row(j) - posed.row(i), from = rest.row(j) - rest.row(i);
            covariance += to.transpose() * from;
            magnitude += to.norm() * from.norm();
            lengths += to.norm() + from.norm();
        }
        const double of_covariance =
            rounding_error_in<Scalar>(count(i) + 3 + 30, magnitude) + 2.0 * of_smoothing * lengths;
        const double of_rotation = 2.0 * of_covariance / rotation_gap(covariance);
        largest = std::max(largest, of_rotation * (mesh.rest.row(i) - rest.row(i)).norm());
    }
    return largest + of_smoothing + std::sqrt(3.0) * rounding_error_in<Scalar>(6, farthest);
}

// Each skinner deforms a body by the settings, plainly in double or packed.
//   error: of a position [m] of its own limb, of coordinates up to `farthest`, in these settings;
//   packed_error: the same for packed code compared with plain code; proves: whether that bound is small enough to
//   prove the code;
//   far_error: by a translation of the pose; blend_error: of what is LBS itself.

struct NoOptions {};

// LBS and dual quaternions. Plainly, a position goes through the roundings of a motion, in which dual quaternions
// divide by |r|^2 >= 1/4 of two bones. Packed, numbers of order one go through some 40 roundings (four columns, two
// cross products) for each of two bones.
template <typename S, bool is_packed, bool is_linear>
struct Blend {
    using Options = NoOptions;
    using Plain = Blend<double, false, is_linear>;
    static constexpr bool packed = is_packed;
    static inline const TwoBoneLimb limb = two_bone_limb({12, 3, 3}, Vec3(0.3, 0.2, 1.0), 80.0);
    static inline const std::vector<Options> settings = {{}}, without_smoothing = {};

    static Positions applied(const TwoBoneLimb& body, const Pose& pose, const Options&)
    {
        Positions posed;
        if constexpr (packed) {
            pbs::BlendSkinning<S> skinning(body.mesh.rest, body.weights);
            is_linear ? skinning.linear(pose, posed) : skinning.dual_quaternion(pose, posed);
        } else {
            (is_linear ? pbs::linear_blend_skinning : pbs::dual_quaternion_skinning)(body.mesh.rest, body.weights, pose,
                                                                                     posed);
        }
        return posed;
    }
    static double error(const Options&, const Pose&, double farthest)
    {
        return packed ? rounding_error_in<S>(2 * 40 * 2, farthest) : motion_error(1, farthest);
    }
    static double packed_error(const Options&) { return rounding_error_in<S>(2 * 40 * 2, 1.0); }
    static bool proves(const Options&) { return !is_linear; }  // LBS is what it is compared with
    static double far_error(const Options& options, const Pose&, double distance)
    {
        return packed_error(options) + motion_error(2, distance + 2.0);
    }
    static double blend_error() { return packed_error({}); }
};

template <typename S, bool is_packed>
struct Delta {
    using Options = DeltaMushOptions;
    using Plain = Delta<double, false>;
    static constexpr bool packed = is_packed;
    static inline const TwoBoneLimb limb = two_bone_limb({16, 4, 4}, Vec3::UnitZ(), 60.0);
    static inline const std::vector<Options> settings = {
        {.iterations = 1}, {.iterations = 3}, {.iterations = 20}, {.iterations = 3, .unsmoothed_share = 0.5}};
    static inline const std::vector<Options> without_smoothing = {{.iterations = 0}, {.iterations = 5, .step = 0.0}};

    static Positions applied(const TwoBoneLimb& body, const Pose& pose, const Options& options)
    {
        Positions posed, blended;
        if constexpr (packed) {
            pbs::BlendSkinning<S> skinning(body.mesh.rest, body.weights);
            pbs::PackedDeltaMush<S>(body.mesh, options).apply(skinning, pose, posed);
        } else {
            pbs::linear_blend_skinning(body.mesh.rest, body.weights, pose, blended);
            pbs::DeltaMush(body.mesh, options).apply(blended, posed);
        }
        return posed;
    }
    // LBS goes through some fifteen roundings. At rest it is exact in plain code, and smoothed in the same roundings as
    // the rest shape.
    static double error(const Options& options, const Pose& pose, double farthest)
    {
        Positions blended;
        pbs::linear_blend_skinning(limb.mesh.rest, limb.weights, pose, blended);
        const bool moved = packed || blended != limb.mesh.rest;
        return mush_error<S>(limb.mesh, blended, moved, farthest, options.iterations) +
               (moved ? rounding_error_in<S>(15, farthest) : 0.0);
    }
    static double packed_error(const Options& options)
    {
        return 2.0 * mush_error<S>(limb.mesh, limb.lbs, true, 1.1, options.iterations) + rounding_error_in<S>(15, 1.1);
    }
    // The bound grows with the iterations, for rounding is assumed to add up, and the smoothed covariances become flat.
    // With three iterations it is far below what delta mush changes, so that it proves the code; with twenty it still
    // holds.
    static bool proves(const Options& options) { return options.iterations < 20; }
    static double far_error(const Options& options, const Pose&, double distance)
    {
        const double of_translation = std::sqrt(3.0) * rounding_error_in<double>(4, distance + 2.0);
        return 2.0 * packed_error(options) +
               Delta<double, true>::packed_error(options) / rounding_error_in<double>(1, 1.1) * of_translation;
    }
    static double blend_error() { return packed ? rounding_error_in<S>(15, 1.1) : 0.0; }
};

inline const TwoBoneLimb bent_bar = two_bone_limb({8, 3, 3}, Vec3(1, 1, 2).normalized(), 70.0);

// The covariance of a vertex, and the sum of its terms' magnitudes.
struct Covariance {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    double magnitude = 0.0, firsts = 0.0;
};

inline Covariance covariance_of(const DirectDeltaMush& mush, Eigen::Index v, const Pose& pose)
{
    Covariance result;
    const Vec3 centre = mush.centre().row(v), origin = pose[mush.moments()[mush.first()[v]].bone] * centre;
    for (int k = mush.first()[v]; k < mush.first()[v + 1]; ++k) {
        const DirectDeltaMush::Moments& of = mush.moments()[k];
        const Vec3 to = pose[of.bone] * centre - origin;
        result.sum += pose[of.bone].linear() * of.second + to * of.first.transpose();
        result.magnitude += of.second.norm() + to.norm() * of.first.norm();
        result.firsts += of.first.norm();
    }
    return result;
}

// How far rounding may move a position [m], coordinates being up to `farthest`, from moments that are in error by the
// share `of_moments` of the square of `farthest`, and by moving them in Scalar: differences of moved centres go through
// ten roundings, the covariance through twelve for each bone and 17 more (nearest_rotation.cpp). An error E of it turns
// the rotation by at most 2 |E| / (s2 + s3), which moves the vertex by that share of its detail.
template <class Scalar>
double direct_error(const DirectDeltaMush& mush, const Pose& pose, double of_moments, double farthest)
{
    double largest = 0.0;
    const int bones = static_cast<int>(pose.size());
    for (Eigen::Index v = 0; v < mush.centre().rows(); ++v) {
        const Covariance covariance = covariance_of(mush, v, pose);
        const double error = rounding_error_in<Scalar>(12 * bones + 17, covariance.magnitude) +
                             rounding_error_in<Scalar>(10, std::sqrt(3.0) * farthest) * covariance.firsts +
                             of_moments * farthest * farthest;
        largest = std::max(largest, 2.0 * error / rotation_gap(covariance.sum) * mush.detail().row(v).norm());
    }
    return largest + rounding_error_in<Scalar>(12 * bones + 6, std::sqrt(3.0) * farthest) + of_moments * farthest;
}

// p direct solves with a matrix whose condition number is below (1 + 2 lambda) times the ratio of the largest to the
// smallest number of neighbours, 14 / 3, in error by at most 3 #V roundings each; the products with u u^T and the
// change of the origin add ten.
inline double of_smoothing(const DirectDeltaMushOptions& options)
{
    const double condition = (1.0 + 2.0 * options.lambda) * 14.0 / 3.0;
    return rounding_error_in<double>(options.iterations * 3.0 * double(bent_bar.mesh.rest.rows()) * condition + 10.0,
                                     1.0);
}

template <typename S, bool is_packed>
struct Direct {
    using Options = DirectDeltaMushOptions;
    using Plain = Direct<double, false>;
    static constexpr bool packed = is_packed;
    static inline const TwoBoneLimb& limb = bent_bar;
    static inline const std::vector<Options> settings = {
        {},
        {.iterations = 3, .lambda = 2.0, .kappa = 1.0, .alpha = 0.8, .negligible = 0.0},
        {.iterations = 6, .lambda = 0.5, .kappa = 0.0, .alpha = 0.0, .negligible = 0.0},
        {.iterations = 6, .lambda = 0.5, .kappa = 0.5, .alpha = 1.0},
        {.iterations = 5, .lambda = 0.75, .kappa = 0.25, .alpha = 0.3, .smoothing = MushSmoothing::explicit_steps},
    };
    // Psi_ij = w_ij u_i u_i^T, so that p_i = u_i and the rotation has nothing to turn. (Its covariance is zero.)
    static inline const std::vector<Options> without_smoothing = {
        {.iterations = 0}, {.iterations = 5, .lambda = 0.0, .kappa = 0.0}, {.iterations = 0, .alpha = 1.0}};

    static Positions applied(const TwoBoneLimb& body, const Pose& pose, const Options& options)
    {
        using Mush = std::conditional_t<packed, pbs::PackedDirectMush<S>, DirectDeltaMush>;
        Positions posed;
        Mush(body.mesh, body.weights, options).apply(pose, posed);
        return posed;
    }
    static double error(const Options& options, const Pose& pose, double farthest)
    {
        const DirectDeltaMush mush(limb.mesh, limb.weights, options);
        return direct_error<double>(mush, pose, of_smoothing(options), farthest) +
               (packed ? direct_error<S>(mush, pose, 0.0, farthest) : 0.0);
    }
    // Moments are rounded once to Scalar, which the covariance's own roundings include.
    static double packed_error(const Options& options)
    {
        return 2.0 * direct_error<S>(DirectDeltaMush(limb.mesh, limb.weights, options), limb.pose, 0.0, 1.1);
    }
    static bool proves(const Options&) { return true; }
    static double far_error(const Options& options, const Pose& pose, double distance)
    {
        return packed_error(options) +
               direct_error<double>(DirectDeltaMush(limb.mesh, limb.weights, options), pose, 0.0, distance + 1.1);
    }
    static double blend_error() { return rounding_error_in<S>(40, 2.0); }
};

// Correctives that are fitted to dual quaternions on the way to the limb's pose and back beyond rest, for a body of any
// size, mirror image and order.
template <typename S, bool is_packed>
struct Corrective {
    using Options = pbs::CorrectiveOptions;
    using Plain = Corrective<double, false>;
    static constexpr bool packed = is_packed;
    static inline const TwoBoneLimb& limb = bent_bar;
    static inline const std::vector<Options> settings = {{.least_strength = 1e-2}, {.rank = 1, .least_strength = 1e-1}};
    static inline const std::vector<Options> without_smoothing = {};
    static constexpr int samples = 6;

    static pbs::Correctives fitted(const TwoBoneLimb& body, const Options& options)
    {
        std::vector<pbs::CorrectiveSample> solved(samples);
        for (int s = 0; s < samples; ++s) {
            const Eigen::AngleAxisd turn(body.pose[1].linear());
            solved[s].pose = {Eigen::Isometry3d::Identity(),
                              Eigen::Isometry3d(Eigen::AngleAxisd(turn.angle() * (1.0 - 0.3 * s), turn.axis()))};
            pbs::dual_quaternion_skinning(body.mesh.rest, body.weights, solved[s].pose, solved[s].shape);
        }
        return pbs::fit_correctives(body.skeleton, body.mesh.rest, body.weights, solved, options);
    }
    static Positions applied(const TwoBoneLimb& body, const Pose& pose, const Options& options)
    {
        const pbs::Correctives correctives = fitted(body, options);
        Positions posed;
        if constexpr (packed)
            pbs::CorrectiveSkinning<S>(correctives, body.mesh.rest, body.weights).apply(pose, posed);
        else
            pbs::corrected_skinning(correctives, body.mesh.rest, body.weights, pose, posed);
        return posed;
    }
    // Coefficients of a ridge of strength s are in error by at most |Y| |dF| (1/4 + 1) / s + |dY| / (2 sqrt s) (P. C.
    // Hansen, Rank-deficient and discrete ill-posed problems, SIAM 1998, Sec. 5.1). Over the largest squared singular
    // value s is `least_strength` or more; features and residuals, which are shorter than the body is long, go through
    // some 60 roundings each.
    static double of_fit(const Options& options, double farthest)
    {
        return rounding_error(options.sweeps * 60.0 * samples * std::sqrt(double(pbs::corrective_features)) *
                                  (1.25 + 0.5) / options.least_strength,
                              farthest);
    }
    static double error(const Options& options, const Pose& pose, double farthest)
    {
        return of_fit(options, farthest) + Blend<S, is_packed, true>::error({}, pose, farthest);
    }
    // A displacement, which is shorter than a coordinate, adds up to eight products.
    static double packed_error(const Options&) { return rounding_error_in<S>(2 * 40 * 2 + 10, 1.0); }
    static bool proves(const Options&) { return true; }
    static double far_error(const Options& options, const Pose&, double distance)
    {
        return packed_error(options) + motion_error(2, distance + 2.0);
    }
    static double blend_error() { return rounding_error_in<S>(2 * 40 * 2, 1.0); }
};

}  // namespace test_support

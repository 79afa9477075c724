// Delta mush and direct delta mush. References: rigid motions, the limits of the definitions, the formulas of the direct one's paper with
// dense matrices, and of packed code the plain one. Tolerances: the rounding of means, and that of the polar decomposition by its
// condition.
#include "pbs/geometry/nearest_rotation.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/geometry/topology.hpp"
#include "pbs/skinning/delta_mush.hpp"
#include "pbs/skinning/direct_delta_mush.hpp"
#include "tests/support/random_points.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/two_bone_limb.hpp"
#include "tests/unit/pbs/character/expect_input_error.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace {

using pbs::DeltaMushOptions;
using pbs::DirectDeltaMush;
using pbs::DirectDeltaMushOptions;
using pbs::MushSmoothing;
using pbs::Pose;
using pbs::Positions;
using pbs::Vec3;
using test_support::rounding_error_in;
using test_support::TwoBoneLimb;
using Matrix4 = Eigen::Matrix4d;

const Pose rest_pose(2, Eigen::Isometry3d::Identity());

// The limb with one more vertex, which no tet uses and the forearm alone moves.
TwoBoneLimb with_loose_vertex(TwoBoneLimb limb)
{
    const Eigen::Index last = limb.mesh.rest.rows();
    limb.mesh.rest.conservativeResize(last + 1, 3);
    limb.mesh.rest.row(last) << 0.9, 0.5, 0.25;
    limb.weights.first.push_back(limb.weights.first.back() + 1);
    limb.weights.bone.push_back(1);
    limb.weights.weight.push_back(1.0);
    pbs::linear_blend_skinning(limb.mesh.rest, limb.weights, limb.pose, limb.lbs);
    return limb;
}

// Mean positions of the neighbours, again and again, half-way: the default step.
Positions halfway_smoothed(const pbs::Adjacency& neighbours, Positions positions, int iterations)
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
double rotation_gap(const Eigen::Matrix3d& covariance)
{
    const Vec3 s = Eigen::JacobiSVD<Eigen::Matrix3d>(covariance).singularValues();
    return s(1) + std::copysign(s(2), covariance.determinant());
}

// How far rounding may move a mushed position [m] of coordinates up to `farthest`, with the default step.
//   Smoothing: each mean of n neighbours goes through n + 4 roundings, and means do not amplify those before. Without a motion, the blend
//   and the rest shape are smoothed in the same roundings.
//   Rotation: the covariance is a sum of n products of smoothed edges, whose ends are in error by smoothing on both sides, and its
//   decomposition rounds some 30 times. An error E of the covariance turns its rotation by at most 2 |E| / (s2 + s3), with s2 and s3 its
//   smaller singular values, the last with the sign of its determinant (C. Kenney, A. J. Laub, SIAM J. Matrix Anal. Appl. 12, 1991), which
//   moves the vertex by that share of its detail. Sum: the detail, its rotated coordinates and their sum go through six roundings.
template <class Scalar>
double mush_error(const pbs::TetMesh& mesh, const Positions& blended, bool moved, double farthest,
                  int iterations = DeltaMushOptions().iterations)
{
    const pbs::Adjacency neighbours = pbs::adjacency_of(mesh.tets, static_cast<int>(mesh.rest.rows()));
    const auto count = [&](int i) { return neighbours.first[i + 1] - neighbours.first[i]; };
    const Positions rest = halfway_smoothed(neighbours, mesh.rest, iterations), posed = halfway_smoothed(neighbours, blended, iterations);
    int most = 0;
    for (int i = 0; i < rest.rows(); ++i) most = std::max(most, count(i));
    const double of_smoothing = moved ? std::sqrt(3.0) * rounding_error_in<Scalar>(iterations * (most + 4), farthest) : 0.0;
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
        const double of_covariance = rounding_error_in<Scalar>(count(i) + 3 + 30, magnitude) + 2.0 * of_smoothing * lengths;
        const double of_rotation = 2.0 * of_covariance / rotation_gap(covariance);
        largest = std::max(largest, of_rotation * (mesh.rest.row(i) - rest.row(i)).norm());
    }
    return largest + of_smoothing + std::sqrt(3.0) * rounding_error_in<Scalar>(6, farthest);
}

// Each deforms a body by the settings, plainly in double or packed. error: of a position [m] of its own limb, of coordinates up to
// `farthest`, in these settings; packed_error: the same for packed code compared with plain code; blend_error: of what is the blend itself.
template <typename S, bool is_packed>
struct Delta {
    using Options = DeltaMushOptions;
    using Plain = Delta<double, false>;
    static constexpr bool packed = is_packed;
    static inline const TwoBoneLimb limb = test_support::two_bone_limb({16, 4, 4}, Vec3::UnitZ(), 60.0);
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
    // LBS goes through some fifteen roundings. At rest it is exact in plain code, and smoothed in the same roundings as the rest shape.
    static double error(const Options& options, const Pose& pose, double farthest)
    {
        Positions blended;
        pbs::linear_blend_skinning(limb.mesh.rest, limb.weights, pose, blended);
        const bool moved = packed || blended != limb.mesh.rest;
        return mush_error<S>(limb.mesh, blended, moved, farthest, options.iterations) + (moved ? rounding_error_in<S>(15, farthest) : 0.0);
    }
    static double packed_error(const Options& options)
    {
        return 2.0 * mush_error<S>(limb.mesh, limb.lbs, true, 1.1, options.iterations) + rounding_error_in<S>(15, 1.1);
    }
    // The bound grows with the iterations, for rounding is assumed to add up, and the smoothed covariances become flat. With three
    // iterations it is far below what delta mush changes, so that it proves the code; with twenty it still holds.
    static bool proves(const Options& options) { return options.iterations < 20; }
    static double far_error(const Pose&, double distance)
    {
        const double of_translation = std::sqrt(3.0) * rounding_error_in<double>(4, distance + 2.0);
        return 2.0 * packed_error({}) + Delta<double, true>::packed_error({}) / rounding_error_in<double>(1, 1.1) * of_translation;
    }
    static double blend_error() { return packed ? rounding_error_in<S>(15, 1.1) : 0.0; }
};

using PlainDelta = Delta<double, false>;

const TwoBoneLimb bent_bar = test_support::two_bone_limb({8, 3, 3}, Vec3(1, 1, 2).normalized(), 70.0);

// The covariance of a vertex, and the sum of its terms' magnitudes.
struct Covariance {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    double magnitude = 0.0, firsts = 0.0;
};

Covariance covariance_of(const DirectDeltaMush& mush, Eigen::Index v, const Pose& pose)
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

// How far rounding may move a position [m], coordinates being up to `farthest`, from moments that are in error by the share `of_moments` of
// the square of `farthest`, and by moving them in Scalar: differences of moved centres go through ten roundings, the covariance through
// twelve for each bone and 17 more (nearest_rotation.cpp). An error E of it turns the rotation by at most 2 |E| / (s2 + s3), which moves
// the vertex by that share of its detail.
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

// p direct solves with a matrix whose condition number is below (1 + 2 lambda) times the ratio of the largest to the smallest number of
// neighbours, 14 / 3, in error by at most 3 #V roundings each; the products with u u^T and the change of the origin add ten.
double of_smoothing(const DirectDeltaMushOptions& options)
{
    const double condition = (1.0 + 2.0 * options.lambda) * 14.0 / 3.0;
    return rounding_error_in<double>(options.iterations * 3.0 * double(bent_bar.mesh.rest.rows()) * condition + 10.0, 1.0);
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
    static double far_error(const Pose& pose, double distance)
    {
        return packed_error({}) + direct_error<double>(DirectDeltaMush(limb.mesh, limb.weights, {}), pose, 0.0, distance + 1.1);
    }
    static double blend_error() { return rounding_error_in<S>(40, 2.0); }
};

double largest(const Positions& difference)
{
    return difference.rowwise().norm().maxCoeff();
}

template <typename Method>
class Mush : public testing::Test {
};
using Mushes = testing::Types<Delta<double, false>, Delta<float, true>, Delta<double, true>, Direct<double, false>, Direct<float, true>,
                              Direct<double, true>>;
TYPED_TEST_SUITE(Mush, Mushes);

TYPED_TEST(Mush, IsThePlainOne)
{
    if (!TypeParam::packed) return;
    for (const auto& options : TypeParam::settings) {
        const Positions expected = TypeParam::Plain::applied(TypeParam::limb, TypeParam::limb.pose, options);
        const double tolerance = TypeParam::packed_error(options);
        EXPECT_LT(largest(TypeParam::applied(TypeParam::limb, TypeParam::limb.pose, options) - expected), tolerance);
        EXPECT_TRUE(!TypeParam::proves(options) || largest(expected - TypeParam::limb.lbs) > 10.0 * tolerance)
            << "a bound that passes LBS proves nothing";
    }
}

TYPED_TEST(Mush, RestComesBack)
{
    const Positions& rest = TypeParam::limb.mesh.rest;
    for (const auto& options : TypeParam::settings)
        EXPECT_LT(largest(TypeParam::applied(TypeParam::limb, rest_pose, options) - rest), TypeParam::error(options, rest_pose, 1.0));
}

// The rest shape by one motion of all bones, and a pose with a motion after it. Both sides are rounded, also by the motion, in some fifteen
// roundings.
TYPED_TEST(Mush, TurnsWithARigidMotion)
{
    test_support::RandomPoints random(51);
    const double farthest = 1.1 + 0.2 * std::sqrt(3.0), of_motion = std::sqrt(3.0) * rounding_error_in<double>(15, farthest);
    const TwoBoneLimb& limb = TypeParam::limb;
    for (const auto& options : TypeParam::settings) {
        const Eigen::Isometry3d motion = random.rigid_motion(0.2);
        Pose moved = limb.pose;
        for (Eigen::Isometry3d& bone : moved) bone = motion * bone;
        const double at_rest = TypeParam::error(options, Pose(2, motion), farthest) + of_motion,
                     posed = 2.0 * TypeParam::error(options, moved, farthest) + of_motion;
        EXPECT_LT(largest(TypeParam::applied(limb, Pose(2, motion), options) - test_support::transformed(limb.mesh.rest, motion)), at_rest);
        EXPECT_LT(largest(TypeParam::applied(limb, moved, options) -
                          test_support::transformed(TypeParam::applied(limb, limb.pose, options), motion)),
                  posed);
        EXPECT_TRUE((!std::is_same_v<TypeParam, PlainDelta>) || at_rest + posed < 1e-9)
            << "a bound that would let a wrong rotation pass proves nothing";
    }
}

TYPED_TEST(Mush, LosesNoDigitsFarFromTheOrigin)
{
    if (!TypeParam::packed) return;
    const Vec3 far(1000.0, -2000.0, 500.0);
    Pose pose = TypeParam::limb.pose;
    for (Eigen::Isometry3d& bone : pose) bone.pretranslate(far);
    const Positions here = TypeParam::applied(TypeParam::limb, TypeParam::limb.pose, {}),
                    there = TypeParam::applied(TypeParam::limb, pose, {});
    EXPECT_LT(largest(there.rowwise() - far.transpose() - here), TypeParam::far_error(pose, far.norm()));
}

TYPED_TEST(Mush, WithoutSmoothingItIsTheBlend)
{
    for (const auto& options : TypeParam::without_smoothing)
        EXPECT_LE((TypeParam::applied(TypeParam::limb, TypeParam::limb.pose, options) - TypeParam::limb.lbs).cwiseAbs().maxCoeff(),
                  TypeParam::blend_error());
}

TYPED_TEST(Mush, AVertexThatNoTetUsesFollowsTheBlend)
{
    const TwoBoneLimb limb = with_loose_vertex(TypeParam::limb);
    const double farther = 1.36;  // 1.5 m from the origin instead of 1.1 m
    EXPECT_LE((TypeParam::applied(limb, limb.pose, {}) - limb.lbs).bottomRows(1).norm(), farther * TypeParam::blend_error());
}

TYPED_TEST(Mush, NotANumberIsNoRotation)
{
    Pose pose = TypeParam::limb.pose;
    pose[1].linear()(0, 0) = std::nan("");
    EXPECT_FALSE(TypeParam::applied(TypeParam::limb, pose, {}).allFinite());
}

// The bulge and the crease of a blend are its sharpest details: smoothing removes them, and the details that are restored are those of the
// rest shape.
TEST(DeltaMush, LosesLessOfEachTetThanTheBlend)
{
    const TwoBoneLimb& bent = PlainDelta::limb;
    const auto lost = [&](const Positions& positions) {
        return (pbs::tet_volumes(positions, bent.mesh.tets) - pbs::tet_volumes(bent.mesh.rest, bent.mesh.tets)).cwiseAbs().sum();
    };
    EXPECT_LT(lost(PlainDelta::applied(bent, bent.pose, {})), lost(bent.lbs));
}

// Vertices on a line have no rotation of their own: the formulae refuse it, and the decomposition takes one of those that are nearest. The
// sharp end of a flat tet is refused likewise. The detail along the bar has the rotation of the bar, which only the turn about its own axis
// leaves open.
TEST(DeltaMush, FlatMeshesAreMovedToo)
{
    TwoBoneLimb flat = PlainDelta::limb;
    flat.mesh.rest.rightCols<2>() *= 1e-6;
    const Positions expected = PlainDelta::applied(flat, flat.pose, {});
    for (const Positions& posed : {Delta<float, true>::applied(flat, flat.pose, {}), Delta<double, true>::applied(flat, flat.pose, {})}) {
        EXPECT_TRUE(posed.allFinite());
        EXPECT_LT(largest(posed - expected), 1e-3 * largest(expected - flat.mesh.rest));
    }
}

// A limb that is three tets thick, with smooth weights, which bends and twists. By theory no tet is inverted by a rotation field as smooth
// as the blend; with smoothed edges alone the limb is a thread, whose frames turn about it in different ways.
TEST(DeltaMush, WithUnsmoothedEdgesThinLimbsAreNotTurnedInsideOut)
{
    TwoBoneLimb thin = test_support::two_bones_in(test_support::structured_bar({-1, -0.025, -0.025}, {1, 0.025, 0.025}, {40, 1, 1}));
    thin.weights = {{0}, {}, {}};
    for (const auto& point : thin.mesh.rest.rowwise()) {
        const double forearm = std::clamp(0.5 + point(0) / 0.3, 0.0, 1.0);
        thin.weights.bone.insert(thin.weights.bone.end(), {0, 1});
        thin.weights.weight.insert(thin.weights.weight.end(), {1.0 - forearm, forearm});
        thin.weights.first.push_back(static_cast<int>(thin.weights.bone.size()));
    }
    test_support::RandomPoints random(74);
    const auto inverted = [&](const Positions& posed) { return (pbs::tet_volumes(posed, thin.mesh.tets).array() <= 0.0).count(); };
    Eigen::Index as_published = 0;
    for (int turn = 0; turn < 20; ++turn) {
        const Vec3 axis = random.rigid_motion(0.0).linear().col(0);
        const Pose pose = pbs::joint_sweep(thin.skeleton, 1, axis, 4.0 * (turn + 1), 2, 0.01).steps.back();
        const DeltaMushOptions wide{.unsmoothed_share = 0.01};
        ASSERT_EQ(inverted(PlainDelta::applied(thin, pose, {.iterations = 0})), 0) << "LBS inverts none";
        EXPECT_EQ(inverted(PlainDelta::applied(thin, pose, wide)), 0) << 4.0 * (turn + 1) << " degrees about " << axis.transpose();
        EXPECT_EQ(inverted(Delta<float, true>::applied(thin, pose, wide)), 0) << 4.0 * (turn + 1) << " degrees about " << axis.transpose();
        as_published += inverted(PlainDelta::applied(thin, pose, {}));
    }
    EXPECT_GT(as_published, 0) << "a limb that the published frames leave whole proves nothing";
}

using PlainDirect = Direct<double, false>;

Eigen::MatrixXd graph_laplacian(const pbs::TetMesh& mesh)
{
    Eigen::MatrixXd laplacian = Eigen::MatrixXd::Zero(mesh.rest.rows(), mesh.rest.rows());
    const pbs::Edges edges = pbs::edges_of(mesh.tets);
    for (const auto& edge : edges.rowwise()) {
        laplacian(edge(0), edge(1)) = laplacian(edge(1), edge(0)) = -1.0;
        laplacian(edge(0), edge(0)) += 1.0;
        laplacian(edge(1), edge(1)) += 1.0;
    }
    return laplacian;
}

Eigen::MatrixXd smoothing_matrix(const Eigen::MatrixXd& laplacian, double step, const DirectDeltaMushOptions& options)
{
    const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(laplacian.rows(), laplacian.rows());
    const Eigen::MatrixXd of_edges = laplacian * laplacian.diagonal().cwiseInverse().asDiagonal();  // L D^-1
    const Eigen::MatrixXd once =
        options.smoothing == MushSmoothing::explicit_steps ? (one - step * of_edges).eval() : (one + step * of_edges).inverse().eval();
    Eigen::MatrixXd result = one;
    for (int iteration = 0; iteration < options.iterations; ++iteration) result = result * once;
    return result;
}

// The paper's formulas as they are printed, about the origin.
Positions dense_direct_mush(const test_support::TwoBoneLimb& limb, const DirectDeltaMushOptions& options)
{
    const Eigen::Index n = limb.mesh.rest.rows();
    const Eigen::MatrixXd laplacian = graph_laplacian(limb.mesh), b = smoothing_matrix(laplacian, options.lambda, options),
                          c = smoothing_matrix(laplacian, options.kappa, options);
    Eigen::MatrixXd w = Eigen::MatrixXd::Zero(n, 2);
    for (int v = 0; v < n; ++v)
        for (int k = limb.weights.first[v]; k < limb.weights.first[v + 1]; ++k) w(v, limb.weights.bone[k]) = limb.weights.weight[k];
    const Eigen::MatrixXd blended = c.transpose() * w;
    Positions posed(n, 3);
    for (Eigen::Index i = 0; i < n; ++i) {
        Matrix4 psi[2] = {Matrix4::Zero(), Matrix4::Zero()};
        for (Eigen::Index k = 0; k < n; ++k) {
            const Eigen::Vector4d u = limb.mesh.rest.row(k).transpose().homogeneous();
            for (int j = 0; j < 2; ++j) psi[j] += b(k, i) * w(k, j) * u * u.transpose();
        }
        const Eigen::Vector4d p = (psi[0] + psi[1]).col(3);
        Matrix4 sum = Matrix4::Zero();
        for (int j = 0; j < 2; ++j)
            sum += limb.pose[j].matrix() * ((1.0 - options.alpha) * psi[j] + options.alpha * blended(i, j) * p * p.transpose());
        const Vec3 q = sum.topRightCorner<3, 1>();
        const Eigen::Matrix3d r = pbs::nearest_rotation_by_svd(sum.topLeftCorner<3, 3>() - q * p.head<3>().transpose());
        posed.row(i) = (q + r * (limb.mesh.rest.row(i).transpose() - p.head<3>())).transpose();
    }
    return posed;
}

TEST(DirectDeltaMush, IsTheDenseEvaluationOfThePaper)
{
    for (DirectDeltaMushOptions options : PlainDirect::settings) {
        options.negligible = 0.0;                      // which the paper does not drop
        options.alpha = std::min(options.alpha, 0.9);  // alpha = 1 leaves the paper's rotations undefined
        const double tolerance = 2.0 * PlainDirect::error(options, bent_bar.pose, 1.1);
        const Positions posed = PlainDirect::applied(bent_bar, bent_bar.pose, options);
        EXPECT_LT((posed - dense_direct_mush(bent_bar, options)).rowwise().norm().maxCoeff(), tolerance);
        EXPECT_LT(tolerance, 1e-6 * (posed - bent_bar.lbs).rowwise().norm().maxCoeff()) << "a bound that passes LBS proves nothing";
    }
}

// With alpha = 0 the centres are the smoothed LBS, as in delta mush; details are turned by other rotations.
TEST(DirectDeltaMush, ItsCentresAreThoseOfDeltaMush)
{
    const DirectDeltaMushOptions options{
        .iterations = 4, .lambda = 0.5, .kappa = 0.5, .alpha = 0.0, .negligible = 0.0, .smoothing = MushSmoothing::explicit_steps};
    const DirectDeltaMush mush(bent_bar.mesh, bent_bar.weights, options);
    const Eigen::MatrixXd b = smoothing_matrix(graph_laplacian(bent_bar.mesh), options.lambda, options);
    const Positions smoothed = b.transpose() * bent_bar.lbs, posed = PlainDirect::applied(bent_bar, bent_bar.pose, options);
    for (Eigen::Index v = 0; v < posed.rows(); ++v)
        EXPECT_NEAR((posed.row(v) - smoothed.row(v)).norm(), mush.detail().row(v).norm(), of_smoothing(options) * 4.0) << v;
}

TEST(DirectDeltaMush, TheOrderOfTheVerticesDoesNotMatter)
{
    test_support::TwoBoneLimb other = bent_bar;
    const int n = static_cast<int>(bent_bar.mesh.rest.rows());
    std::vector<int> place(n);
    for (int v = 0; v < n; ++v) place[v] = (v * 31 + 7) % n;  // 31 and n have no common factor
    ASSERT_EQ(std::gcd(31, n), 1);
    std::vector<int> vertex_at(n);
    for (int v = 0; v < n; ++v) vertex_at[place[v]] = v;
    other.weights = {{0}, {}, {}};
    for (int i = 0; i < n; ++i) {
        const int v = vertex_at[i];
        other.mesh.rest.row(i) = bent_bar.mesh.rest.row(v);
        for (int k = bent_bar.weights.first[v]; k < bent_bar.weights.first[v + 1]; ++k) {
            other.weights.bone.push_back(bent_bar.weights.bone[k]);
            other.weights.weight.push_back(bent_bar.weights.weight[k]);
        }
        other.weights.first.push_back(static_cast<int>(other.weights.bone.size()));
    }
    for (int& v : other.mesh.tets.reshaped()) v = place[v];
    for (const DirectDeltaMushOptions& options : PlainDirect::settings) {
        const Positions posed = PlainDirect::applied(bent_bar, bent_bar.pose, options),
                        permuted = PlainDirect::applied(other, bent_bar.pose, options);
        EXPECT_LT(largest(posed - permuted(place, Eigen::all)), 2.0 * PlainDirect::error(options, bent_bar.pose, 1.1));
    }
}

// A dropped entry of weight w moves a centre by at most w times the farthest distance of two moved centres, and its moments are a share w
// of the square of that; two bones drop at most one.
TEST(DirectDeltaMush, DroppedEntriesAreNegligible)
{
    for (const double negligible : {1e-3, 1e-5}) {
        DirectDeltaMushOptions options{.iterations = 2, .lambda = 0.3, .kappa = 0.3, .negligible = 0.0};
        const DirectDeltaMush all(bent_bar.mesh, bent_bar.weights, options);
        options.negligible = negligible;
        const DirectDeltaMush most(bent_bar.mesh, bent_bar.weights, options);
        Positions of_all, of_most;
        all.apply(bent_bar.pose, of_all), most.apply(bent_bar.pose, of_most);
        EXPECT_LT(most.moments().size(), all.moments().size());
        EXPECT_LT(largest(of_all - of_most), direct_error<double>(all, bent_bar.pose, 2.0 * negligible, 2.2));
    }
}

TEST(DirectDeltaMush, OptionsOutOfRangeAreRefused)
{
    const auto refused = [](const DirectDeltaMushOptions& options, const std::string& field, const std::string& rule) {
        expect_input_error([&] { DirectDeltaMush(bent_bar.mesh, bent_bar.weights, options); }, "direct_delta_mush: " + field, rule);
    };
    refused({.iterations = -1}, "iterations = -1", "expected 0 or more");
    refused({.lambda = -1.0}, "lambda = -1", "expected 0 or more");
    refused({.lambda = 1.5, .smoothing = MushSmoothing::explicit_steps}, "lambda = 1.5", "at most 1 with explicit steps");
    refused({.lambda = 1.0, .kappa = 2.0}, "kappa = 2", "kappa <= lambda");
    refused({.alpha = 1.5}, "alpha = 1.5", "0 <= alpha <= 1");
    refused({.negligible = 0.5}, "negligible = 0.5", "negligible <= 1e-3");
}

}  // namespace

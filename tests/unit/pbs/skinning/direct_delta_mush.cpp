// Reference: the formulas of the paper with dense matrices, rigid motions, and the definition's limits. Tolerances: direct_error below.
#include "pbs/skinning/direct_delta_mush.hpp"

#include "pbs/geometry/nearest_rotation.hpp"
#include "pbs/geometry/topology.hpp"
#include "tests/support/mush_rounding.hpp"
#include "tests/support/random_points.hpp"
#include "tests/support/two_bone_limb.hpp"
#include "tests/unit/pbs/character/expect_input_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace {

using pbs::DirectDeltaMush;
using pbs::DirectDeltaMushOptions;
using pbs::MushSmoothing;
using pbs::Pose;
using pbs::Positions;
using pbs::Vec3;
using Matrix4 = Eigen::Matrix4d;
using test_support::rounding_error_in;

const test_support::TwoBoneLimb bent_bar = test_support::two_bone_limb({8, 3, 3}, Vec3(1, 1, 2).normalized(), 70.0);

const DirectDeltaMushOptions direct_settings[] = {
    {},
    {.iterations = 3, .lambda = 2.0, .kappa = 1.0, .alpha = 0.8, .negligible = 0.0},
    {.iterations = 6, .lambda = 0.5, .kappa = 0.0, .alpha = 0.0, .negligible = 0.0},
    {.iterations = 6, .lambda = 0.5, .kappa = 0.5, .alpha = 1.0},
    {.iterations = 5, .lambda = 0.75, .kappa = 0.25, .alpha = 0.3, .smoothing = MushSmoothing::explicit_steps},
};

Positions direct_mush(const DirectDeltaMush& mush, const Pose& pose)
{
    Positions posed;
    mush.apply(pose, posed);
    return posed;
}

Positions direct_mush(const DirectDeltaMushOptions& options, const Pose& pose)
{
    return direct_mush(DirectDeltaMush(bent_bar.mesh, bent_bar.weights, options), pose);
}

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
        largest = std::max(largest, 2.0 * error / test_support::rotation_gap(covariance.sum) * mush.detail().row(v).norm());
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

double direct_error(const DirectDeltaMushOptions& options, const Pose& pose, double farthest)
{
    const DirectDeltaMush mush(bent_bar.mesh, bent_bar.weights, options);
    return direct_error<double>(mush, pose, of_smoothing(options), farthest);
}

TEST(DirectDeltaMush, IsTheDenseEvaluationOfThePaper)
{
    for (DirectDeltaMushOptions options : direct_settings) {
        options.negligible = 0.0;                      // which the paper does not drop
        options.alpha = std::min(options.alpha, 0.9);  // alpha = 1 leaves the paper's rotations undefined
        const double tolerance = 2.0 * direct_error(options, bent_bar.pose, 1.1);
        const Positions posed = direct_mush(options, bent_bar.pose);
        EXPECT_LT((posed - dense_direct_mush(bent_bar, options)).rowwise().norm().maxCoeff(), tolerance);
        EXPECT_LT(tolerance, 1e-6 * (posed - bent_bar.lbs).rowwise().norm().maxCoeff()) << "a bound that passes LBS proves nothing";
    }
}

TEST(DirectDeltaMush, RestComesBack)
{
    const Pose rest(2, Eigen::Isometry3d::Identity());
    for (const DirectDeltaMushOptions& options : direct_settings)
        EXPECT_LT((direct_mush(options, rest) - bent_bar.mesh.rest).rowwise().norm().maxCoeff(), direct_error(options, rest, 1.1));
}

TEST(DirectDeltaMush, ARigidMotionOfAllBonesIsReproduced)
{
    test_support::RandomPoints random(51);
    for (const DirectDeltaMushOptions& options : direct_settings) {
        const Eigen::Isometry3d motion = random.rigid_motion(0.5);
        const Positions expected = test_support::transformed(bent_bar.mesh.rest, motion);
        EXPECT_LT((direct_mush(options, Pose(2, motion)) - expected).rowwise().norm().maxCoeff(),
                  direct_error(options, Pose(2, motion), 1.1 + 0.5 * std::sqrt(3.0)));
    }
}

// A motion after the pose moves the result with it.
TEST(DirectDeltaMush, TurnsWithARigidMotion)
{
    test_support::RandomPoints random(52);
    for (const DirectDeltaMushOptions& options : direct_settings) {
        const Eigen::Isometry3d motion = random.rigid_motion(0.5);
        Pose pose = bent_bar.pose;
        for (Eigen::Isometry3d& bone : pose) bone = motion * bone;
        EXPECT_LT((direct_mush(options, pose) - test_support::transformed(direct_mush(options, bent_bar.pose), motion))
                      .rowwise()
                      .norm()
                      .maxCoeff(),
                  2.0 * direct_error(options, pose, 1.1 + 0.5 * std::sqrt(3.0)));
    }
}

// Without smoothing Psi_ij = w_ij u_i u_i^T, so that p_i = u_i and the rotation has nothing to turn. (Its covariance is zero.)
TEST(DirectDeltaMush, WithoutSmoothingItIsTheBlend)
{
    for (const DirectDeltaMushOptions& options :
         {DirectDeltaMushOptions{.iterations = 0}, {.iterations = 5, .lambda = 0.0, .kappa = 0.0}, {.iterations = 0, .alpha = 1.0}})
        EXPECT_LT((direct_mush(options, bent_bar.pose) - bent_bar.lbs).cwiseAbs().maxCoeff(), rounding_error_in<double>(40, 2.0));
}

// With alpha = 0 the centres are the smoothed LBS, as in delta mush; details are turned by other rotations.
TEST(DirectDeltaMush, ItsCentresAreThoseOfDeltaMush)
{
    const DirectDeltaMushOptions options{
        .iterations = 4, .lambda = 0.5, .kappa = 0.5, .alpha = 0.0, .negligible = 0.0, .smoothing = MushSmoothing::explicit_steps};
    const DirectDeltaMush mush(bent_bar.mesh, bent_bar.weights, options);
    const Eigen::MatrixXd b = smoothing_matrix(graph_laplacian(bent_bar.mesh), options.lambda, options);
    const Positions smoothed = b.transpose() * bent_bar.lbs, posed = direct_mush(mush, bent_bar.pose);
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
    for (const DirectDeltaMushOptions& options : direct_settings) {
        const Positions posed = direct_mush(options, bent_bar.pose),
                        permuted = direct_mush(DirectDeltaMush(other.mesh, other.weights, options), bent_bar.pose);
        double largest = 0.0;
        for (int v = 0; v < n; ++v) largest = std::max(largest, (posed.row(v) - permuted.row(place[v])).norm());
        EXPECT_LT(largest, 2.0 * direct_error(options, bent_bar.pose, 1.1));
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
        EXPECT_LT(most.moments().size(), all.moments().size());
        EXPECT_LT((direct_mush(all, bent_bar.pose) - direct_mush(most, bent_bar.pose)).rowwise().norm().maxCoeff(),
                  direct_error<double>(all, bent_bar.pose, 2.0 * negligible, 2.2));
    }
}

TEST(DirectDeltaMush, AVertexThatNoTetUsesFollowsTheBlend)
{
    const test_support::TwoBoneLimb limb = test_support::with_loose_vertex(bent_bar);
    const Positions posed = direct_mush(DirectDeltaMush(limb.mesh, limb.weights, {}), limb.pose);
    EXPECT_LT((posed.bottomRows(1) - limb.lbs.bottomRows(1)).norm(), rounding_error_in<double>(40, 3.0));
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

template <class Scalar>
class PackedDirectMushOf : public testing::Test {
};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(PackedDirectMushOf, Scalars);

// Moments are rounded once to Scalar, which the covariance's own roundings include.
TYPED_TEST(PackedDirectMushOf, IsThePlainOne)
{
    for (const DirectDeltaMushOptions& options : direct_settings) {
        const DirectDeltaMush plain(bent_bar.mesh, bent_bar.weights, options);
        Positions posed;
        pbs::PackedDirectMush<TypeParam>(bent_bar.mesh, bent_bar.weights, options).apply(bent_bar.pose, posed);
        const Positions expected = direct_mush(plain, bent_bar.pose);
        const double tolerance = 2.0 * direct_error<TypeParam>(plain, bent_bar.pose, 0.0, 1.1);
        EXPECT_LT((posed - expected).rowwise().norm().maxCoeff(), tolerance);
        EXPECT_GT((expected - bent_bar.lbs).rowwise().norm().maxCoeff(), 10.0 * tolerance) << "a bound that passes LBS proves nothing";
    }
}

TYPED_TEST(PackedDirectMushOf, LosesNoDigitsFarFromTheOrigin)
{
    const Vec3 far(1000.0, -2000.0, 500.0);
    const DirectDeltaMush plain(bent_bar.mesh, bent_bar.weights, {});
    pbs::PackedDirectMush<TypeParam> mush(bent_bar.mesh, bent_bar.weights, {});
    Pose pose = bent_bar.pose;
    for (Eigen::Isometry3d& bone : pose) bone.pretranslate(far);
    Positions here, there;
    mush.apply(bent_bar.pose, here);
    mush.apply(pose, there);
    const double tolerance =
        2.0 * direct_error<TypeParam>(plain, bent_bar.pose, 0.0, 1.1) + direct_error<double>(plain, pose, 0.0, far.norm() + 1.1);
    EXPECT_LT((there.rowwise() - far.transpose() - here).rowwise().norm().maxCoeff(), tolerance);
}

TYPED_TEST(PackedDirectMushOf, WithoutSmoothingItIsTheBlend)
{
    Positions posed;
    pbs::PackedDirectMush<TypeParam>(bent_bar.mesh, bent_bar.weights, {.iterations = 0}).apply(bent_bar.pose, posed);
    EXPECT_LT((posed - bent_bar.lbs).cwiseAbs().maxCoeff(), (rounding_error_in<TypeParam>(40, 2.0)));
}

}  // namespace

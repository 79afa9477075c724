// Delta mush and direct delta mush, beyond the contract of the skinners (contract.cpp). References: the formulas of the
// direct one's paper with dense matrices, and what is known of bent and thin limbs. Tolerances:
// tests/support/skinners.hpp.
#include "pbs/geometry/nearest_rotation.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "tests/support/random_points.hpp"
#include "tests/support/skinners.hpp"
#include "tests/unit/experiments/characters/expect_input_error.hpp"

#include <gtest/gtest.h>

namespace delta_mush_tests {
namespace {

using namespace test_support;
using Matrix4 = Eigen::Matrix4d;
using PlainDelta = Delta<double, false>;
using PlainDirect = Direct<double, false>;

double largest_distance(const Positions& difference)
{
    return difference.rowwise().norm().maxCoeff();
}

// The bulge and the crease of a blend are its sharpest details: smoothing removes them, and the details that are
// restored are those of the rest shape.
TEST(DeltaMush, LosesLessOfEachTetThanTheBlend)
{
    const TwoBoneLimb& bent = PlainDelta::limb;
    const auto lost = [&](const Positions& positions) {
        return (pbs::tet_volumes(positions, bent.mesh.tets) - pbs::tet_volumes(bent.mesh.rest, bent.mesh.tets))
            .cwiseAbs()
            .sum();
    };
    EXPECT_LT(lost(PlainDelta::applied(bent, bent.pose, {})), lost(bent.lbs));
}

// Vertices on a line have no rotation of their own: the formulae refuse it, and the decomposition takes one of those
// that are nearest. The sharp end of a flat tet is refused likewise. The detail along the bar has the rotation of the
// bar, which only the turn about its own axis leaves open.
TEST(DeltaMush, FlatMeshesAreMovedToo)
{
    TwoBoneLimb flat = PlainDelta::limb;
    flat.mesh.rest.rightCols<2>() *= 1e-6;
    const Positions expected = PlainDelta::applied(flat, flat.pose, {});
    for (const Positions& posed :
         {Delta<float, true>::applied(flat, flat.pose, {}), Delta<double, true>::applied(flat, flat.pose, {})}) {
        EXPECT_TRUE(posed.allFinite());
        EXPECT_LT(largest_distance(posed - expected), 1e-3 * largest_distance(expected - flat.mesh.rest));
    }
}

// A limb that is three tets thick, with smooth weights, which bends and twists. By theory no tet is inverted by a
// rotation field as smooth as the blend; with smoothed edges alone the limb is a thread, whose frames turn about it in
// different ways.
TEST(DeltaMush, WithUnsmoothedEdgesThinLimbsAreNotTurnedInsideOut)
{
    TwoBoneLimb thin = two_bones_in(structured_bar({-1, -0.025, -0.025}, {1, 0.025, 0.025}, {40, 1, 1}));
    thin.weights = {{0}, {}, {}};
    for (const auto& point : thin.mesh.rest.rowwise()) {
        const double forearm = std::clamp(0.5 + point(0) / 0.3, 0.0, 1.0);
        thin.weights.bone.insert(thin.weights.bone.end(), {0, 1});
        thin.weights.weight.insert(thin.weights.weight.end(), {1.0 - forearm, forearm});
        thin.weights.first.push_back(static_cast<int>(thin.weights.bone.size()));
    }
    RandomPoints random(74);
    const auto inverted = [&](const Positions& posed) {
        return (pbs::tet_volumes(posed, thin.mesh.tets).array() <= 0.0).count();
    };
    Eigen::Index as_published = 0;
    for (int turn = 0; turn < 20; ++turn) {
        const Vec3 axis = random.rigid_motion(0.0).linear().col(0);
        const Pose pose = pbs::joint_sweep(thin.skeleton, 1, axis, 4.0 * (turn + 1), 2, 0.01).steps.back();
        const DeltaMushOptions wide{.unsmoothed_share = 0.01};
        ASSERT_EQ(inverted(PlainDelta::applied(thin, pose, {.iterations = 0})), 0) << "LBS inverts none";
        EXPECT_EQ(inverted(PlainDelta::applied(thin, pose, wide)), 0)
            << 4.0 * (turn + 1) << " degrees about " << axis.transpose();
        EXPECT_EQ(inverted(Delta<float, true>::applied(thin, pose, wide)), 0)
            << 4.0 * (turn + 1) << " degrees about " << axis.transpose();
        as_published += inverted(PlainDelta::applied(thin, pose, {}));
    }
    EXPECT_GT(as_published, 0) << "a limb that the published frames leave whole proves nothing";
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
    const Eigen::MatrixXd once = options.smoothing == MushSmoothing::explicit_steps
                                     ? (one - step * of_edges).eval()
                                     : (one + step * of_edges).inverse().eval();
    Eigen::MatrixXd result = one;
    for (int iteration = 0; iteration < options.iterations; ++iteration) result = result * once;
    return result;
}

// The paper's formulas as they are printed, about the origin.
Positions dense_direct_mush(const TwoBoneLimb& limb, const DirectDeltaMushOptions& options)
{
    const Eigen::Index n = limb.mesh.rest.rows();
    const Eigen::MatrixXd laplacian = graph_laplacian(limb.mesh),
                          b = smoothing_matrix(laplacian, options.lambda, options),
                          c = smoothing_matrix(laplacian, options.kappa, options);
    Eigen::MatrixXd w = Eigen::MatrixXd::Zero(n, 2);
    for (int v = 0; v < n; ++v)
        for (int k = limb.weights.first[v]; k < limb.weights.first[v + 1]; ++k)
            w(v, limb.weights.bone[k]) = limb.weights.weight[k];
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
            sum += limb.pose[j].matrix() *
                   ((1.0 - options.alpha) * psi[j] + options.alpha * blended(i, j) * p * p.transpose());
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
        EXPECT_LT(tolerance, 1e-6 * (posed - bent_bar.lbs).rowwise().norm().maxCoeff())
            << "a bound that passes LBS proves nothing";
    }
}

// With alpha = 0 the centres are the smoothed LBS, as in delta mush; details are turned by other rotations.
TEST(DirectDeltaMush, ItsCentresAreThoseOfDeltaMush)
{
    const DirectDeltaMushOptions options{.iterations = 4,
                                         .lambda = 0.5,
                                         .kappa = 0.5,
                                         .alpha = 0.0,
                                         .negligible = 0.0,
                                         .smoothing = MushSmoothing::explicit_steps};
    const DirectDeltaMush mush(bent_bar.mesh, bent_bar.weights, options);
    const Eigen::MatrixXd b = smoothing_matrix(graph_laplacian(bent_bar.mesh), options.lambda, options);
    const Positions smoothed = b.transpose() * bent_bar.lbs,
                    posed = PlainDirect::applied(bent_bar, bent_bar.pose, options);
    for (Eigen::Index v = 0; v < posed.rows(); ++v)
        EXPECT_NEAR((posed.row(v) - smoothed.row(v)).norm(), mush.detail().row(v).norm(), of_smoothing(options) * 4.0)
            << v;
}

// A dropped entry of weight w moves a centre by at most w times the farthest distance of two moved centres, and its
// moments are a share w of the square of that; two bones drop at most one.
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
        EXPECT_LT(largest_distance(of_all - of_most), direct_error<double>(all, bent_bar.pose, 2.0 * negligible, 2.2));
    }
}

TEST(DirectDeltaMush, OptionsOutOfRangeAreRefused)
{
    const auto refused = [](const DirectDeltaMushOptions& options, const std::string& field, const std::string& rule) {
        expect_input_error([&] { DirectDeltaMush(bent_bar.mesh, bent_bar.weights, options); },
                           "direct_delta_mush: " + field, rule);
    };
    refused({.iterations = -1}, "iterations = -1", "expected 0 or more");
    refused({.lambda = -1.0}, "lambda = -1", "expected 0 or more");
    refused({.lambda = 1.5, .smoothing = MushSmoothing::explicit_steps}, "lambda = 1.5",
            "at most 1 with explicit steps");
    refused({.lambda = 1.0, .kappa = 2.0}, "kappa = 2", "kappa <= lambda");
    refused({.alpha = 1.5}, "alpha = 1.5", "0 <= alpha <= 1");
    refused({.negligible = 0.5}, "negligible = 0.5", "negligible <= 1e-3");
}

}  // namespace
}  // namespace delta_mush_tests

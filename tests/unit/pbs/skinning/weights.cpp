// Reference: Eq. 2 evaluated by hand.
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/topology.hpp"
#include "pbs/skinning/weights.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/structured_bar.hpp"
#include "tests/support/two_bone_limb.hpp"
#include "tests/support/weight_sums.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

// Reference: projections on segments along the axes, by hand. Tolerances: the rounding of motions.

namespace weights_tests {
namespace {

using pbs::Vec3;
using test_support::motion_error;

const pbs::Skeleton limb = {{{"upper", -1, {-1, 0, 0}, {0, 0, 0}}, {"forearm", 0, {0, 0, 0}, {1, 0, 0}}}};

pbs::BoneBinding bind_one(const Vec3& vertex, const pbs::Skeleton& skeleton)
{
    return pbs::bind_to_nearest_bone(pbs::Positions(vertex.transpose()), skeleton);
}

TEST(BoneBinding, IsTheNearestPointWithAnUnclampedParameter)
{
    const pbs::Skeleton point = {{{"point", -1, {1, 1, 1}, {1, 1, 1}}}};
    struct Case {
        const char* name;
        const pbs::Skeleton& skeleton;
        Vec3 vertex, rest_point;
        int bone;
        double parameter, distance;
    };
    const Case cases[] = {
        {"beside a bone", limb, {0.25, 0.3, 0.4}, {0.25, 0, 0}, 1, 0.25, 0.5},
        {"beyond a tail", limb, {1.5, 0, 0}, {1, 0, 0}, 1, 1.5, 0.5},
        {"before a head", limb, {-3, 0, 0}, {-1, 0, 0}, 0, -2.0, 2.0},
        {"the first of equals", limb, {0, 0.2, 0}, {0, 0, 0}, 0, 1.0, 0.2},
        {"on the bone", limb, {0.5, 0, 0}, {0.5, 0, 0}, 1, 0.5, 0.0},
        {"a bone of length zero is a point", point, {1, 1, 3}, {1, 1, 1}, 0, 0.0, 2.0},
    };
    for (const auto& [name, skeleton, vertex, rest_point, bone, parameter, distance] : cases) {
        SCOPED_TRACE(name);
        const pbs::BoneBinding binding = bind_one(vertex, skeleton);
        EXPECT_EQ(binding.bone[0], bone);
        EXPECT_DOUBLE_EQ(binding.parameter(0), parameter);
        EXPECT_EQ(Vec3(binding.rest_point.row(0)), rest_point);
        EXPECT_DOUBLE_EQ(binding.distance(0), distance);
    }
    EXPECT_THROW(bind_one({0, 0, 0}, {}), pbs::InputError) << "no bones";
}

TEST(BindToNearestBone, TakesTheNearestOfTheBonesThatMayHoldAVertex)
{
    const pbs::Positions rest = (pbs::Positions(2, 3) << -0.5, 0.1, 0, -0.5, 0.1, 0).finished();
    const auto forearm_holds_the_second = [](int vertex, int bone) { return vertex == 1 && bone == 1; };
    const pbs::BoneBinding binding = pbs::bind_to_nearest_bone(rest, limb, forearm_holds_the_second);
    EXPECT_EQ(binding.bone, (std::vector<int>{0, 1})) << "no bone may hold the first: the nearest one does";
    EXPECT_EQ(Vec3(binding.rest_point.row(1)), Vec3(0, 0, 0));
}

TEST(PosedBindPoints, AreCarriedByTheirBones)
{
    const pbs::Positions rest = (pbs::Positions(2, 3) << -0.5, 0.1, 0, 0.5, 0.1, 0).finished();
    const pbs::BoneBinding binding = pbs::bind_to_nearest_bone(rest, limb);
    const pbs::Pose pose = pbs::joint_sweep(limb, 1, Vec3::UnitZ(), 90.0, 2, 0.01).steps[1];
    const pbs::Positions points = pbs::posed_bind_points(binding, pose);
    EXPECT_LT((Vec3(points.row(0)) - Vec3(-0.5, 0, 0)).norm(), motion_error(1, 0.5));
    EXPECT_LT((Vec3(points.row(1)) - Vec3(0, 0.5, 0)).norm(), motion_error(2, 0.5));
}

// The forearm turned by 90 degrees about z lies along y; (0.1, 0.4, 0) is 0.4 along it, and (0.3, 2, 0) beyond its
// tail.
TEST(ReprojectedBindPoints, AreOnThePosedSegment)
{
    const pbs::Positions rest = (pbs::Positions(2, 3) << 0.5, 0.1, 0, 0.9, 0.1, 0).finished();
    const pbs::BoneBinding binding = pbs::bind_to_nearest_bone(rest, limb);
    const pbs::Pose bent = pbs::joint_sweep(limb, 1, Vec3::UnitZ(), 90.0, 2, 0.01).steps.back();
    const pbs::Positions moved = (pbs::Positions(2, 3) << 0.1, 0.4, 0, 0.3, 2.0, 0).finished();
    const pbs::Positions points = pbs::reprojected_bind_points(binding, limb, bent, moved);
    // two of the bone, one for the projection
    EXPECT_LT((Vec3(points.row(0)) - Vec3(0, 0.4, 0)).norm(), motion_error(3, 1.0));
    EXPECT_LT((Vec3(points.row(1)) - Vec3(0, 1, 0)).norm(), motion_error(3, 1.0));
}

TEST(ReprojectedBindPoints, OfARigidlyMovedBodyAreTheCarriedOnes)
{
    const pbs::Positions rest = (pbs::Positions(2, 3) << -0.5, 0.1, 0.2, 0.9, 0.1, 0).finished();
    const pbs::BoneBinding binding = pbs::bind_to_nearest_bone(rest, limb);
    const pbs::Pose turned(
        2, Eigen::Isometry3d(Eigen::Translation3d(1, 2, 3) * Eigen::AngleAxisd(0.7, Vec3(1, 2, 2) / 3.0)));
    pbs::Positions moved(2, 3);
    for (int i = 0; i < 2; ++i) moved.row(i) = turned[0] * Vec3(rest.row(i));
    EXPECT_LT(
        (pbs::reprojected_bind_points(binding, limb, turned, moved) - pbs::posed_bind_points(binding, turned)).norm(),
        // of two points: the body, the points, and the projection on the moved bone
        std::sqrt(2.0) * motion_error(1 + 1 + 3, 5.0));
}

// A palm with three fingers that start at its tail.
pbs::Skeleton palm()
{
    return {{{"palm", -1, {0, 0, 0}, {1, 0, 0}},
             {"thumb", 0, {1, 0, 0}, {1, 1, 0}},
             {"middle", 0, {1, 0, 0}, {2, 0, 0}},
             {"little", 0, {1, 0, 0}, {1, -1, 0}}}};
}

TEST(PaperWeights, AreSharedByTheBonesAtTheJoint)
{
    const pbs::Skeleton sixes = {{{"a", -1, {-6, 0, 0}, {0, 0, 0}}, {"b", 0, {0, 0, 0}, {6, 0, 0}}}};
    const pbs::Skeleton single = {{{"only", -1, {0, 0, 0}, {1, 0, 0}}}};
    const pbs::Skeleton with_point = {{{"point", -1, {0, 0, 0}, {0, 0, 0}}, {"bone", 0, {0, 0, 0}, {1, 0, 0}}}};
    struct Case {
        const char* name;
        pbs::Skeleton skeleton;
        Vec3 vertex;
        std::vector<int> bones;  // with equal weights
    };
    const Case cases[] = {
        {"one in the middle", palm(), {0.5, 0.1, 0}, {0}},
        {"at the joint", palm(), {0.9, 0.01, 0}, {0, 1, 2, 3}},
        {"the same four bones from the other side", palm(), {1.1, 0.01, 0}, {2, 0, 1, 3}},
        {"near the free head", palm(), {0.05, 0.1, 0}, {0}},
        {"before the free head", palm(), {-0.5, 0, 0}, {0}},
        {"beyond a free tail", palm(), {2.5, 0, 0}, {2}},
        {"the bound t = 1/6 is inclusive", sixes, {1, 0, 0}, {1}},
        {"the bound t = 5/6 is inclusive", sixes, {-1, 0, 0}, {0}},
        {"just below t = 1/6", sixes, {0.999, 0, 0}, {1, 0}},
        {"just above t = 5/6", sixes, {-0.999, 0, 0}, {0, 1}},
        {"before a single bone", single, {-1, 0, 0}, {0}},
        {"the head of a single bone", single, {0, 0, 0}, {0}},
        {"the middle of a single bone", single, {0.5, 0, 0}, {0}},
        {"the tail of a single bone", single, {1, 0, 0}, {0}},
        {"beyond a single bone", single, {2, 0, 0}, {0}},
        {"a bone of length zero at its joint", with_point, {-0.5, 0, 0}, {0, 1}},
    };
    for (const auto& [name, skeleton, vertex, bones] : cases) {
        const pbs::Weights weights = pbs::paper_weights(bind_one(vertex, skeleton), skeleton);
        EXPECT_EQ(weights.bone, bones) << name;
        EXPECT_EQ(weights.weight, std::vector(bones.size(), 1.0 / double(bones.size()))) << name;
        EXPECT_EQ(weights.blended(0), bones.size() > 1) << name;
    }
}

TEST(RigidWeights, AreTheNearestBoneAlone)
{
    const pbs::Positions rest{{0.95, 0, 0}, {1.9, 0, 0}};
    const pbs::Weights weights = pbs::rigid_weights(pbs::bind_to_nearest_bone(rest, palm()));
    EXPECT_EQ(weights.vertices(), 2);
    EXPECT_EQ(weights.bone, (std::vector{0, 2}));
    EXPECT_EQ(weights.weight, (std::vector{1.0, 1.0}));
}

// Bones a, b, c in a row: b touches a and c; near its far end, a touches only b.
TEST(EitherEndWeights, AreOfAllBonesThatTouchTheBone)
{
    const pbs::Skeleton row = {
        {{"a", -1, {-3, 0, 0}, {0, 0, 0}}, {"b", 0, {0, 0, 0}, {3, 0, 0}}, {"c", 1, {3, 0, 0}, {6, 0, 0}}}};
    const pbs::Positions rest{{2.9, 0.1, 0}, {1.5, 0.1, 0}, {-2.9, 0.1, 0}};
    const pbs::Weights weights = pbs::either_end_weights(pbs::bind_to_nearest_bone(rest, row), row);
    EXPECT_EQ(weights.first, (std::vector{0, 3, 4, 6}));
    EXPECT_EQ(weights.bone, (std::vector{1, 0, 2, 1, 0, 1}));
    EXPECT_EQ(weights.weight, (std::vector{1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0, 1.0, 0.5, 0.5}));
}

// Reference: harmonic functions of one coordinate are linear in it, and linear elements represent those exactly.

using pbs::harmonic_weights;

const pbs::TetMesh bar = test_support::structured_bar({0, 0, 0}, {1, 0.2, 0.2}, {10, 2, 2});

Eigen::MatrixXd dense(const pbs::Weights& weights, int bones)
{
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(weights.vertices(), bones);
    for (int v = 0; v < weights.vertices(); ++v)
        for (int e = weights.first[v]; e < weights.first[v + 1]; ++e) matrix(v, weights.bone[e]) += weights.weight[e];
    return matrix;
}

// Whole cross-sections are gripped beyond x = 0.2 and x = 0.7. The term that keeps the matrix L regular, 1e-9 of its
// diagonal D, changes the weights by at most 1e-9 max(L^-1 D 1), by the maximum principle. With w the weight of the
// edges along x at a vertex and h the cell, L f = w h^2 for f = (x - 0.2) (0.7 - x) / 2, and D <= 10 w in cubes of six
// tets, whose edges have a weight of h / 6 or h / 3. Rounding is a millionth of that.
TEST(HarmonicWeights, AreLinearBetweenGrippedCrossSections)
{
    std::vector<int> gripping(bar.rest.rows(), -1);
    for (Eigen::Index v = 0; v < bar.rest.rows(); ++v) {
        if (bar.rest(v, 0) < 0.2 + 1e-9) gripping[v] = 0;
        if (bar.rest(v, 0) > 0.7 - 1e-9) gripping[v] = 1;
    }
    const Eigen::MatrixXd weights = dense(harmonic_weights(bar, gripping, 2), 2);
    const double of_regularity = 1e-9 * 10.0 * (0.5 * 0.5 / 8.0) / (0.1 * 0.1);
    for (int v = 0; v < bar.rest.rows(); ++v) {
        const double expected = std::clamp((bar.rest(v, 0) - 0.2) / 0.5, 0.0, 1.0);
        EXPECT_NEAR(weights(v, 1), expected, of_regularity);
        EXPECT_NEAR(weights(v, 0) + weights(v, 1), 1.0, test_support::mean_error(2, 1.0));
    }
    const Eigen::MatrixXd ungripped = dense(harmonic_weights(bar, std::vector<int>(bar.rest.rows(), -1), 2), 2);
    EXPECT_EQ(ungripped.col(0).minCoeff(), 1.0) << "a part that nothing grips goes with the first bone";
}

// Reference: functions that are linear in the place are harmonic, and linear elements represent them exactly. The term
// 1e-9 that keeps the system regular and the removal of weights below 1e-6 change weights by less than 3e-6.

using pbs::harmonic_extension;

constexpr double extension_tolerance = 3e-6;
const pbs::TetMesh extension_bar = test_support::structured_bar({0, 0, 0}, {1, 1, 0.5}, {6, 5, 4});

// Three weights that are linear in the place and sum to one.
Eigen::MatrixXd linear_weights_of(const pbs::Positions& rest)
{
    Eigen::MatrixXd weights(rest.rows(), 3);
    weights.col(0) = 0.2 + 0.3 * rest.col(0).array();
    weights.col(1) = 0.1 + 0.2 * rest.col(1).array() + 0.1 * rest.col(2).array();
    weights.col(2) = 1.0 - weights.col(0).array() - weights.col(1).array();
    return weights;
}

TEST(HarmonicExtension, ReproducesLinearWeightsFromTheBoundary)
{
    const std::vector<bool> boundary = pbs::boundary_vertices(extension_bar.tets, extension_bar.rest.rows());
    const Eigen::MatrixXd expected = linear_weights_of(extension_bar.rest);
    Eigen::MatrixXd given = expected;
    int inside = 0;
    for (Eigen::Index v = 0; v < given.rows(); ++v)
        if (!boundary[std::size_t(v)]) {
            given.row(v).setConstant(77.0);  // not read
            ++inside;
        }
    EXPECT_EQ(inside, 5 * 4 * 3);
    EXPECT_LE((dense(harmonic_extension(extension_bar, boundary, given), 3) - expected).cwiseAbs().maxCoeff(),
              extension_tolerance);
}

// Weights are from the least to the greatest known one (maximum principle, whose condition the Kuhn tets of cubes
// fulfil).
TEST(HarmonicExtension, StaysBetweenTheKnownWeightsAndSumsToOne)
{
    std::vector<bool> known(std::size_t(extension_bar.rest.rows()), false);
    Eigen::MatrixXd given = Eigen::MatrixXd::Zero(extension_bar.rest.rows(), 2);
    for (Eigen::Index v = 0; v < given.rows(); ++v) {
        if (v % 5 != 0) continue;
        known[std::size_t(v)] = true;
        given(v, 0) = v % 2 == 0 ? 0.25 : 0.75;
        given(v, 1) = 1.0 - given(v, 0);
    }
    const Eigen::MatrixXd extended = dense(harmonic_extension(extension_bar, known, given), 2);
    EXPECT_GE(extended.minCoeff(), 0.25 - extension_tolerance);
    EXPECT_LE(extended.maxCoeff(), 0.75 + extension_tolerance);
    EXPECT_LE((extended.rowwise().sum().array() - 1.0).abs().maxCoeff(), 1e-14);
}

// Known weights stay; those of a millionth are removed, and the others are divided by their sum.
TEST(HarmonicExtension, OfAllOrNoKnownWeights)
{
    const Eigen::Index rows = extension_bar.rest.rows();
    const std::vector<bool> all(rows, true), none(rows, false);
    const Eigen::MatrixXd linear = linear_weights_of(extension_bar.rest);
    EXPECT_LE((dense(harmonic_extension(extension_bar, all, linear), 3) - linear).cwiseAbs().maxCoeff(), 1e-14);
    const Eigen::RowVector3d given(0.5, 5e-7, 1.5), expected(0.25, 0.0, 0.75);
    EXPECT_EQ(dense(harmonic_extension(extension_bar, all, given.replicate(rows, 1)), 3),
              Eigen::MatrixXd(expected.replicate(rows, 1)));
    EXPECT_EQ(dense(harmonic_extension(extension_bar, none, Eigen::MatrixXd::Zero(rows, 2)), 2).col(0).minCoeff(), 1.0)
        << "the first bone";
}

// Reference: the definition on rows of cross-sections, and what diffusion conserves.

using pbs::diffused_weights;

const test_support::TwoBoneLimb straight = test_support::two_bone_limb({16, 3, 3}, pbs::Vec3::UnitZ(), 0.0);

// The largest difference of the forearm's weight between two ends of an edge.
double largest_jump(const pbs::Weights& weights)
{
    const Eigen::VectorXd forearm = dense(weights, 2).col(1);
    double largest = 0.0;
    const pbs::Edges edges = pbs::edges_of(straight.mesh.tets);
    for (const auto& edge : edges.rowwise()) largest = std::max(largest, std::abs(forearm(edge(0)) - forearm(edge(1))));
    return largest;
}

TEST(DiffusedWeights, ArePositiveAndAddUpToOneAndWithoutStepsAreTheGivenOnes)
{
    for (const int steps : {0, 1, 8, 100}) {
        const pbs::Weights weights = diffused_weights(straight.mesh, straight.weights, steps);
        ASSERT_EQ(weights.vertices(), straight.mesh.rest.rows());
        for (const double weight : weights.weight) EXPECT_GT(weight, 0.0);
        for (int v = 0; v < weights.vertices(); ++v)
            EXPECT_NEAR(test_support::sum_of_weights(weights, v), 1.0, test_support::mean_error(3, 1.0));
    }
    EXPECT_EQ(dense(diffused_weights(straight.mesh, straight.weights, 0), 2), dense(straight.weights, 2));
}

TEST(DiffusedWeights, OneStepGoesHalfWayToTheMeanOfTheNeighbours)
{
    const pbs::TetMesh tet{pbs::Positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {2, 2, 2}},
                           pbs::Tets{{0, 1, 2, 3}}};
    const pbs::Weights given = {{0, 1, 2, 3, 4, 5}, {0, 1, 1, 1, 0}, {1.0, 1.0, 1.0, 1.0, 1.0}};
    const Eigen::VectorXd first = dense(diffused_weights(tet, given, 1), 2).col(0);
    EXPECT_NEAR(first(0), 0.5, test_support::rounding_error(6, 1.0));
    EXPECT_NEAR(first(1), 0.5 / 3.0, test_support::rounding_error(6, 1.0));
    EXPECT_EQ(first(4), 1.0) << "a vertex without tets keeps its own";
}

// A step takes means, so that the jumps along edges do not grow, and spread over several edges they fall.
TEST(DiffusedWeights, JumpLessFromVertexToVertex)
{
    const double given = largest_jump(straight.weights),
                 once = largest_jump(diffused_weights(straight.mesh, straight.weights, 1)),
                 eight = largest_jump(diffused_weights(straight.mesh, straight.weights));
    EXPECT_EQ(given, 0.5);
    EXPECT_LT(once, given);
    EXPECT_LT(eight, 0.5 * given);
}

}  // namespace
}  // namespace weights_tests

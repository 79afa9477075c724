// Reference: the interpolations of glTF 2.0, Appendix C, and skinned points, computed by hand. Tolerances: at most 64
// roundings of numbers of at most 8.

#include "experiments/rigs/rigged_body.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/two_joint_rig.hpp"
#include "tests/unit/experiments/characters/expect_input_error.hpp"

#include <gtest/gtest.h>

namespace {

using namespace pbs;

const double pose_rounding = test_support::rounding_error(64, 8.0);

TEST(KeyTracks, LinearVectorsLieBetweenTheirKeys)
{
    const KeyTrack track{Interpolation::linear, {1.0, 3.0}, {{0, 2, 4, 0}, {4, 2, 0, 0}}};
    EXPECT_EQ(vector_at(track, 1.5), Vec3(1, 2, 3));
    EXPECT_EQ(vector_at(track, 3.0), Vec3(4, 2, 0));
}

TEST(KeyTracks, BeforeTheFirstAndAfterTheLastKeyTheValueIsThatKeys)
{
    for (const Interpolation kind : {Interpolation::step, Interpolation::linear}) {
        const KeyTrack track{kind, {1.0, 3.0}, {{1, 0, 0, 0}, {2, 0, 0, 0}}};
        EXPECT_EQ(vector_at(track, -5.0).x(), 1.0);
        EXPECT_EQ(vector_at(track, 9.0).x(), 2.0);
    }
    const Eigen::Vector4d tangent(7, 0, 0, 0), one(1, 0, 0, 0), two(2, 0, 0, 0);
    const KeyTrack spline{Interpolation::cubic_spline, {1.0, 3.0}, {tangent, one, tangent, tangent, two, tangent}};
    EXPECT_EQ(vector_at(spline, 0.0).x(), 1.0);
    EXPECT_EQ(vector_at(spline, 3.0).x(), 2.0);
    EXPECT_EQ(vector_at(spline, 4.0).x(), 2.0);
}

TEST(KeyTracks, StepsSingleKeysAndJumps)
{
    const auto track = [](Interpolation kind, const std::vector<double>& times_s, const std::vector<double>& x) {
        std::vector<Eigen::Vector4d> values;
        for (const double value : x) values.emplace_back(value, 0, 0, 0);
        return KeyTrack{kind, times_s, values};
    };
    const KeyTrack step = track(Interpolation::step, {0.0, 1.0, 2.0}, {1, 2, 3});
    const KeyTrack single = track(Interpolation::linear, {0.5}, {4});
    const KeyTrack jump = track(Interpolation::linear, {0.0, 1.0, 1.0, 2.0}, {0, 1, 5, 6});
    for (const auto& [keys, time_s, x] : {std::tuple(&step, 0.999, 1.0),
                                          {&step, 1.0, 2.0},
                                          {&step, 1.5, 2.0},
                                          {&single, 0.0, 4.0},
                                          {&single, 0.5, 4.0},
                                          {&single, 1.0, 4.0},
                                          {&jump, 0.5, 0.5},
                                          {&jump, 1.0, 5.0},
                                          {&jump, 1.5, 5.5}})
        EXPECT_EQ(vector_at(*keys, time_s), Vec3(x, 0, 0)) << time_s;
}

// At the middle of two keys: (p0 + p1) / 2 + distance (m0 - m1) / 8.
TEST(KeyTracks, ACubicSplineAtItsMiddle)
{
    const Eigen::Vector4d p0(1, 0, 2, 0), p1(3, 1, 6, 0), m0(4, 0, 1, 0), m1(2, 8, 1, 0), other(9, 9, 9, 0);
    const KeyTrack track{Interpolation::cubic_spline, {0.0, 2.0}, {other, p0, m0, m1, p1, other}};
    EXPECT_EQ(vector_at(track, 1.0), Vec3(2.0 + 2.0 * 2.0 / 8.0, 0.5 - 2.0 * 8.0 / 8.0, 4.0));
}

// Tangents are derivatives with respect to seconds.
TEST(KeyTracks, ACubicSplineReproducesACubicPolynomial)
{
    const auto value = [](double t) { return t * t * t - 2.0 * t * t + 0.5 * t + 1.0; };
    const auto slope = [](double t) { return 3.0 * t * t - 4.0 * t + 0.5; };
    KeyTrack track{Interpolation::cubic_spline, {0.25, 1.0, 2.0}, {}};
    for (const double t : track.times_s)
        for (const double number : {slope(t), value(t), slope(t)}) track.values.emplace_back(number, 0, 0, 0);
    for (const double t : {0.25, 0.3, 0.7, 1.0, 1.1, 1.9, 2.0})
        EXPECT_NEAR(vector_at(track, t).x(), value(t), pose_rounding) << t;
}

TEST(KeyTracks, RotationsTurnAtAConstantRateTheShorterWay)
{
    for (const double sign : {1.0, -1.0}) {  // q and -q are one rotation
        const Eigen::Quaterniond end(Eigen::AngleAxisd(M_PI / 2.0, Vec3::UnitX()));
        const KeyTrack track{Interpolation::linear, {0.0, 1.0}, {{0, 0, 0, 1}, sign * end.coeffs()}};
        const Eigen::Quaterniond third = rotation_at(track, 1.0 / 3.0);
        const Eigen::Quaterniond expected(Eigen::AngleAxisd(M_PI / 6.0, Vec3::UnitX()));
        EXPECT_NEAR(std::abs(third.dot(expected)), 1.0, pose_rounding);
        EXPECT_NEAR(third.angularDistance(expected), 0.0, pose_rounding);
    }
}

TEST(KeyTracks, RotationsHaveUnitLength)
{
    EXPECT_EQ(rotation_at({Interpolation::step, {0.0}, {{0, 0, 3, 4}}}, 0.0).coeffs(), Eigen::Vector4d(0, 0, 0.6, 0.8));
    const Eigen::Vector4d still = Eigen::Vector4d::Zero();
    const KeyTrack track{
        Interpolation::cubic_spline, {0.0, 1.0}, {still, {0, 0, 0, 1}, still, still, {0, 0, 1, 0}, still}};
    const Eigen::Quaterniond middle = rotation_at(track, 0.5);  // (0, 0, 1, 1) / 2 before it is normalised
    EXPECT_NEAR(middle.z(), std::sqrt(0.5), pose_rounding);
    EXPECT_NEAR(middle.w(), std::sqrt(0.5), pose_rounding);
}

TEST(FindAnimation, TheFirstOneWithoutANameAndAnErrorThatListsTheNames)
{
    Rig rig = test_support::two_joint_rig();
    rig.animations.push_back({"Walk", 0.0, 1.0, {}});
    EXPECT_EQ(find_animation(rig, ""), &rig.animations[0]);
    EXPECT_EQ(find_animation(rig, "Walk"), &rig.animations[1]);
    expect_input_error([&] { find_animation(rig, "walk"); },
                       "arm.gltf: animation = walk: ", "expected one of Bend, Walk");
    rig.animations.clear();
    EXPECT_EQ(find_animation(rig, ""), nullptr);
    expect_input_error([&] { find_animation(rig, "Walk"); },
                       "arm.gltf: animation = Walk: ", "the file has no animation");
}

// Reference: rigid motions of two bones and the artist's points, by hand. A rotation from a singular value
// decomposition is in error by some hundred roundings.

const double rigid_rounding = test_support::rounding_error(256, 8.0);

struct PosedBody {
    Rig rig;
    RiggedBody body;
    std::vector<Eigen::Affine3d> nodes;
};

// The rig of two joints at a time of its animation, after its root was scaled at rest and in the animation.
PosedBody posed_body(double time_s, const Vec3& scale = Vec3::Ones(), double metres = 1.0)
{
    PosedBody made{test_support::two_joint_rig(), {}, {}};
    made.body = make_rigged_body(made.rig, nullptr, metres);
    made.rig.nodes[0].rest.scale = scale;
    made.nodes = node_transforms(made.rig, &made.rig.animations[0], time_s);
    return made;
}

TEST(RigidPose, OfTheRestPoseIsTheIdentity)
{
    for (const Eigen::Isometry3d& bone : rigid_pose(posed_body(0.0).body, posed_body(0.0).nodes))
        EXPECT_LE((bone.matrix() - Eigen::Matrix4d::Identity()).cwiseAbs().maxCoeff(), rigid_rounding);
}

TEST(RigidPose, CarriesRestPointsAndTheArtistsToTheirPlacesInMetres)
{
    const PosedBody half_round = posed_body(1.0, Vec3::Ones(), 0.5);
    const Pose pose = rigid_pose(half_round.body, half_round.nodes);
    EXPECT_LE((pose[0] * Vec3(0.5, 2, 0) - Vec3(0.5, 2, 0)).norm(), rigid_rounding);
    EXPECT_LE((pose[1] * Vec3(0.5, 2, 0) - Vec3(0.5, 0, 0)).norm(), rigid_rounding);  // about (0.5, 1, 0)
    const Positions expected{{1, 0, 0}, {1, 2, 0}, {1, 0, 0}, {0.5, 2, 0}};
    const Positions points = artist_points(half_round.body, half_round.nodes);
    EXPECT_LE((points - 0.5 * expected).cwiseAbs().maxCoeff(), rigid_rounding);
    EXPECT_LE((artist_points(half_round.body, pose) - points).cwiseAbs().maxCoeff(), rigid_rounding)
        << "as of a clip, which has no nodes";
}

TEST(RigidPose, LeavesOutScaleWhichTheArtistsPointsKeepAndReportsIt)
{
    double stretch = 0.0;
    const PosedBody scaled = posed_body(0.0, Vec3(1, 1.5, 1));
    const Pose pose = rigid_pose(scaled.body, scaled.nodes, &stretch);
    EXPECT_NEAR(stretch, 0.5, rigid_rounding);
    EXPECT_LE((pose[0].linear() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), rigid_rounding);
    EXPECT_LE((pose[1] * Vec3(1, 2, 0) - Vec3(1, 3, 0)).norm(), rigid_rounding) << "the head follows the joint";
    const Positions expected = scaled.rig.meshes[0].points * Vec3(1, 1.5, 1).asDiagonal();
    EXPECT_LE((artist_points(scaled.body, scaled.nodes) - expected).cwiseAbs().maxCoeff(), rigid_rounding);
}

TEST(RigidPose, OfAMirroredBoneIsARotation)
{
    const PosedBody mirrored = posed_body(0.0, Vec3(-1, 1, 1));
    for (const Eigen::Isometry3d& bone : rigid_pose(mirrored.body, mirrored.nodes))
        EXPECT_NEAR(bone.linear().determinant(), 1.0, rigid_rounding);
}

// Reference: poses of nodes and skinned points, computed by hand. Tolerances: at most 64 roundings of numbers of at
// most 8.

using test_support::two_joint_rig;

const double skin_rounding = test_support::rounding_error(64, 8.0);

void expect_points(const Positions& points, const Positions& expected)
{
    ASSERT_EQ(points.rows(), expected.rows());
    EXPECT_LE((points - expected).cwiseAbs().maxCoeff(), skin_rounding) << points << "\nexpected\n" << expected;
}

Positions posed(const Rig& rig, double time_s)
{
    return skinned_points(rig.meshes[0], node_transforms(rig, &rig.animations[0], time_s));
}

TEST(NodeTransforms, ArePutTogetherFromTranslationRotationAndScale)
{
    NodeTransform transform;
    transform.translation = Vec3(1, 2, 3);
    transform.rotation = Eigen::Quaterniond(0, 0, 0, 1);  // half round about z
    transform.scale = Vec3(2, 3, -4);
    EXPECT_EQ(transform.affine() * Vec3(1, 1, 1), Vec3(-1, -1, -1));
    transform.matrix = Eigen::Affine3d(Eigen::Scaling(2.0));
    EXPECT_EQ(transform.affine() * Vec3(1, 1, 1), Vec3(2, 2, 2));
}

TEST(NodeTransforms, AreThoseOfTheNodesAboveToo)
{
    Rig rig = two_joint_rig();
    rig.nodes[0].rest.scale = Vec3(2, 2, 2);
    const auto nodes = node_transforms(rig, nullptr, 0.0);
    EXPECT_EQ(nodes[0] * Vec3(0, 0, 0), Vec3(1, 0, 0));
    EXPECT_EQ(nodes[1] * Vec3(1, 0, 0), Vec3(3, 4, 0));
}

TEST(NodeTransforms, WhatHasNoKeysStaysAsItIsAtRest)
{
    Rig rig = two_joint_rig();
    rig.nodes[1].rest.scale = Vec3(1, 3, 1);
    const auto nodes = node_transforms(rig, &rig.animations[0], 1.0);
    EXPECT_LE((nodes[1] * Vec3(0, 1, 0) - Vec3(1, -1, 0)).norm(), skin_rounding);
}

TEST(SkinnedPoints, OfTwoJointsByHand)
{
    const Rig rig = two_joint_rig();  // whose bind pose is the rest pose
    expect_points(skinned_points(rig.meshes[0], node_transforms(rig, nullptr, 0.0)), rig.meshes[0].points);
    Positions quarter(4, 3), half(4, 3);
    quarter << 1, 0, 0, 1, 2, 0, -1, 2, 0, 0.25 * 2 + 0.75 * 1, 0.25 * 2 + 0.75 * 3, 0;
    half << 1, 0, 0, 1, 2, 0, 1, 0, 0, 0.25 * 2 + 0.75 * 0, 2, 0;
    expect_points(posed(rig, 0.5), quarter);
    expect_points(posed(rig, 1.0), half);
}

TEST(SkinnedPoints, FollowTheirNodeOnlyWithoutASkinAndAreMirroredByANegativeScale)
{
    Rig elsewhere = two_joint_rig(), mirrored = elsewhere, without_skin = elsewhere;
    elsewhere.nodes[2].rest.translation = Vec3(5, 5, 5);  // that of the skinned mesh: glTF 2.0, Sec. 3.7.3.3
    expect_points(posed(elsewhere, 0.5), posed(two_joint_rig(), 0.5));

    mirrored.nodes[0].rest.scale = Vec3(-1, 1, 1);  // about the root joint at x = 1
    Positions expected = mirrored.meshes[0].points;
    expected.col(0) = 2.0 - expected.col(0).array();
    expect_points(skinned_points(mirrored.meshes[0], node_transforms(mirrored, nullptr, 0.0)), expected);

    without_skin.meshes[0].joints.clear();
    without_skin.meshes[0].node = 1;
    expected = without_skin.meshes[0].points.rowwise() + Eigen::RowVector3d(1, 2, 0);
    expect_points(skinned_points(without_skin.meshes[0], node_transforms(without_skin, nullptr, 0.0)), expected);
}

// A rigid motion of the root moves all points in the same way, whatever their weights.
TEST(SkinnedPoints, MoveRigidlyWithTheRoot)
{
    Rig rig = two_joint_rig();
    const Positions before = posed(rig, 0.25);
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()));
    const Vec3 shift(0.5, -1, 2);
    rig.nodes[0].rest.rotation = turn;
    rig.nodes[0].rest.translation = turn * Vec3(1, 0, 0) + shift;
    const Positions expected = ((before * turn.toRotationMatrix().transpose()).rowwise() + shift.transpose()).eval();
    expect_points(posed(rig, 0.25), expected);
}

}  // namespace

// Reference: the bones, weights and poses of a rig of two joints, by hand. Tolerances: at most 64 roundings of numbers
// of at most 8; a rotation from a singular value decomposition is in error by some hundred of them.

#include "experiments/rigs/rigged_body.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/two_joint_rig.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace pbs;
using test_support::two_joint_rig;

const double body_rounding = test_support::rounding_error(256, 8.0);

TEST(RiggedBody, HasABonePerJointThatMovesPoints)
{
    const RiggedBody body = make_rigged_body(two_joint_rig(), nullptr, 1.0);
    ASSERT_EQ(body.skeleton.bones.size(), 2u);
    EXPECT_EQ(body.skeleton.bones[0].name, "root");
    EXPECT_EQ(body.skeleton.bones[0].parent, -1);
    EXPECT_LE((body.skeleton.bones[0].head - Vec3(1, 0, 0)).norm(), body_rounding);
    EXPECT_EQ(body.skeleton.bones[1].name, "elbow");
    EXPECT_EQ(body.skeleton.bones[1].parent, 0);
    EXPECT_LE((body.skeleton.bones[1].head - Vec3(1, 2, 0)).norm(), body_rounding);
    EXPECT_EQ(body.node, (std::vector<int>{0, 1}));
    EXPECT_TRUE(body.dropped.empty());
    EXPECT_TRUE(body.remarks.empty());
}

TEST(RiggedBody, HasTheSurfaceAndTheWeightsOfAllItsMeshes)
{
    Rig rig = two_joint_rig();
    RigMesh second = rig.meshes[0];
    std::swap(second.joints[0], second.joints[1]);  // its joint 0 is the elbow
    second.points.conservativeResize(3, 3);
    second.triangles = (Triangles(1, 3) << 0, 2, 1).finished();
    second.skin = test_support::one_joint_each({0, 0, 1});
    rig.meshes.push_back(second);
    const RiggedBody body = make_rigged_body(rig, nullptr, 1.0);
    ASSERT_EQ(body.surface.rows(), 7);
    EXPECT_LE((body.surface.bottomRows(3) - second.points).cwiseAbs().maxCoeff(), body_rounding);
    EXPECT_EQ(body.triangles, (Triangles(3, 3) << 0, 1, 3, 1, 2, 3, 4, 6, 5).finished());
    EXPECT_EQ(body.skin.first, (std::vector<int>{0, 1, 3, 4, 6, 7, 8, 9}));
    EXPECT_EQ(body.skin.bone, (std::vector<int>{0, 0, 1, 1, 0, 1, 1, 1, 0}));
}

TEST(RiggedBody, HasTheLookOfAllItsMeshesWithZerosWhereOneHasNone)
{
    Rig rig = two_joint_rig();
    rig.meshes.push_back(rig.meshes[0]);
    rig.meshes.push_back(rig.meshes[0]);
    rig.meshes[1].look.put(0, 3, Eigen::MatrixXf::Constant(4, 2, 0.5F));
    rig.meshes[1].look.put(2, 0, Eigen::MatrixXf::Constant(1, 3, std::nanf("")));
    rig.meshes[1].look.material = {7, 2};
    const RiggedBody body = make_rigged_body(rig, nullptr, 1.0);
    Eigen::MatrixXf expected = Eigen::MatrixXf::Zero(12, 5);
    expected.block(4, 3, 4, 2).setConstant(0.5F);
    EXPECT_EQ(Eigen::MatrixXf(body.look.numbers), expected);
    EXPECT_EQ(body.look.material, (std::vector<int>{-1, -1, 7, 2, -1, -1}));
}

TEST(RiggedBody, AJointWithoutWeightIsNoBoneAndReported)
{
    Rig rig = two_joint_rig();
    rig.nodes.push_back(test_support::rig_node("", 1, {0, 1, 0}));
    rig.meshes[0].joints.push_back(test_support::joint_bound_at(3, {1, 3, 0}));
    const RiggedBody body = make_rigged_body(rig, nullptr, 1.0);
    EXPECT_EQ(body.skeleton.bones.size(), 2u);
    ASSERT_EQ(body.dropped.size(), 1u);
    EXPECT_EQ(body.dropped[0].name, "node 3");
    EXPECT_EQ(body.dropped[0].reason, "moves no point");
}

TEST(RiggedBody, TheParentOfABoneIsTheNextBoneAbove)
{
    Rig rig = two_joint_rig();  // an unweighted node between the joints
    rig.nodes = {test_support::rig_node("root", -1, {1, 0, 0}), test_support::rig_node("between", 0, {0, 1, 0}),
                 test_support::rig_node("elbow", 1, {0, 1, 0}), test_support::rig_node("body", -1, {0, 0, 0})};
    rig.meshes[0].joints[1].node = 2;
    rig.meshes[0].node = 3;
    rig.animations.clear();
    const RiggedBody body = make_rigged_body(rig, nullptr, 1.0);
    ASSERT_EQ(body.skeleton.bones.size(), 2u);
    EXPECT_EQ(body.skeleton.bones[1].parent, 0);
    EXPECT_EQ(body.containers, std::vector<std::string>{"between"});
}

TEST(RiggedBody, TwoJointsOfOneNameGetNumbersAndANoteAndAFileWithoutJointsHasNoBones)
{
    Rig rig = two_joint_rig(), without_joints = rig;
    rig.nodes[1].name = "root";
    const RiggedBody body = make_rigged_body(rig, nullptr, 1.0);
    EXPECT_EQ(body.skeleton.bones[1].name, "root 2");
    EXPECT_EQ(body.notes, std::vector<std::string>{"two joints are named root; one is called root 2"});
    without_joints.animations.clear();
    without_joints.meshes[0].joints.clear();
    const RiggedBody statue = make_rigged_body(without_joints, nullptr, 1.0);
    EXPECT_TRUE(statue.skeleton.bones.empty());
    EXPECT_EQ(statue.surface, without_joints.meshes[0].points);
}

TEST(RiggedBody, AClosedSurfaceInsideOutIsTurnedWithANote)
{
    const Triangles outward = (Triangles(4, 3) << 0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3).finished();  // of the unit tet
    Rig rig = two_joint_rig();
    rig.meshes[0].points << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
    rig.meshes[0].triangles = outward;
    EXPECT_TRUE(make_rigged_body(rig, nullptr, 1.0).notes.empty());
    rig.meshes[0].triangles.col(1).swap(rig.meshes[0].triangles.col(2));
    const RiggedBody body = make_rigged_body(rig, nullptr, 1.0);
    EXPECT_EQ(body.triangles, outward);
    EXPECT_EQ(body.notes,
              std::vector<std::string>{"the surface is inside out; it is taken as the body that it encloses"});
}

TEST(RiggedBody, TheAngleFromTheBindPoseToTheRestPoseIsReported)
{
    Rig rig = two_joint_rig();
    // the angle of a small rotation: the root of eps
    EXPECT_NEAR(make_rigged_body(rig, nullptr, 1.0).bind_pose_deg, 0.0, 1e-6);
    rig.nodes[1].rest.rotation = Eigen::AngleAxisd(M_PI / 5.0, Vec3(1, 1, 0).normalized());
    EXPECT_NEAR(make_rigged_body(rig, nullptr, 1.0).bind_pose_deg, 36.0, 1e-9);
}

// Reference: the rules of the header on rigs whose joints and points have round coordinates. Tolerances: at most 64
// roundings of numbers of at most 8.

using test_support::rig_node;

const double tail_rounding = test_support::rounding_error(64, 8.0);

struct PlacedJoint {
    std::string name;
    int parent;
    Vec3 place;  // in the scene
};

// A rig of joints in this order and of points that follow one joint each.
Rig rig_with(const std::vector<PlacedJoint>& joints, const std::vector<Vec3>& points,
             const std::vector<int>& joint_of_point)
{
    Rig rig;
    RigMesh mesh;
    for (std::size_t j = 0; j < joints.size(); ++j) {
        const auto& [name, parent, place] = joints[j];
        rig.nodes.push_back(
            rig_node(name, parent, parent < 0 ? place : Vec3(place - joints[std::size_t(parent)].place)));
        mesh.joints.push_back(test_support::joint_bound_at(int(j), place));
    }
    rig.nodes.push_back(rig_node("body", -1, Vec3::Zero()));
    mesh.node = int(joints.size());
    mesh.points.resize(Eigen::Index(points.size()), 3);
    for (std::size_t p = 0; p < points.size(); ++p) mesh.points.row(Eigen::Index(p)) = points[p].transpose();
    mesh.triangles = (Triangles(1, 3) << 0, 1, 2).finished();
    mesh.skin = test_support::one_joint_each(joint_of_point);
    rig.meshes = {mesh};
    return rig;
}

// A chain a - helper - b whose helper moves no point. Rotations of all three change no distance, and translations of b
// and the helper add up.
TEST(RiggedBody, TheDistanceOfABoneFromItsParentIsAlongTheJointsBetweenThem)
{
    Rig rig = rig_with({{"a", -1, {0, 0, 0}}, {"helper", 0, {0, 2, 0}}, {"b", 1, {0, 3, 0}}},
                       {{0, 0, 1}, {0, 4, 0}, {1, 3, 0}}, {0, 2, 2});
    RigAnimation animation{"Move", 0.0, 1.0, {}};
    const Vec3 axis = Vec3(1, 2, 3).normalized() * std::sin(0.5);
    const Eigen::Vector4d rest(0, 0, 0, 1), turned(axis.x(), axis.y(), axis.z(), std::cos(0.5));
    for (const int node : {0, 1, 2})
        animation.nodes.push_back(
            {.node = node, .rotation = KeyTrack{.times_s = {0.0, 1.0}, .values = {rest, turned}}});
    const MotionSampling sampling{.rate_hz = 2.0, .time_step_s = 0.25};
    const auto distances = [&] {
        const RiggedBody body = make_rigged_body(rig, nullptr, 1.0);
        return rig_motion(rig, body, animation, sampling).distances;
    };
    EXPECT_EQ(distances().at(0).change_m, 0.0) << "a root";
    EXPECT_LE(std::abs(distances().at(1).change_m), body_rounding) << "only rotations";
    animation.nodes[1].translation = KeyTrack{.times_s = {0.0, 1.0}, .values = {{0, 2, 0, 0}, {0, 5, 0, 0}}};
    EXPECT_NEAR(distances().at(1).change_m, 3.0, body_rounding);
    EXPECT_NEAR(distances().at(1).relative, 1.0, body_rounding) << "from 3 to 6";
    EXPECT_EQ(distances().at(1).frame, 2);
}

Vec3 tail_of(const std::string& name, const Rig& rig)
{
    const RiggedBody body = make_rigged_body(rig, nullptr, 1.0);
    return body.skeleton.bones.at(static_cast<std::size_t>(find_bone(body.skeleton, name))).tail;
}

void expect_tail(const std::string& rule, const Vec3& tail, const std::string& bone,
                 const std::vector<PlacedJoint>& joints, const std::vector<Vec3>& points,
                 const std::vector<int>& joint_of_point)
{
    EXPECT_LE((tail_of(bone, rig_with(joints, points, joint_of_point)) - tail).norm(), tail_rounding) << rule;
}

TEST(BoneTails, FollowTheRules)
{
    const std::vector<Vec3> upwards = {{0, 1, 0}, {0, 2, 0}, {0, 4, 0}};
    expect_tail("a bone ends at the joint below it", {0, 2, 0}, "a", {{"a", -1, {0, 0, 0}}, {"b", 0, {0, 2, 0}}},
                upwards, {0, 1, 1});
    expect_tail("a joint below without weight counts too", {3, 0, 0}, "a",
                {{"a", -1, {0, 0, 0}}, {"end", 0, {3, 0, 0}}}, {{1, 0, 0}, {2, 0, 0}, {0, 1, 0}}, {0, 0, 0});
    expect_tail("several joints below end it in their middle", {4, -1, 0}, "hand",
                {{"hand", -1, {0, 0, 0}}, {"b", 0, {4, 1, 0}}, {"c", 0, {4, -3, 0}}},
                {{1, 0, 0}, {4, 1, 0}, {4, -3, 0}}, {0, 1, 2});
    expect_tail("joints on opposite sides end it at the one that moves most", {0, 3, 0}, "hips",
                {{"hips", -1, {0, 0, 0}}, {"spine", 0, {0, 3, 0}}, {"tail", 0, {0, -3, 0}}},
                {{0, 0, 1}, {0, 3, 0}, {0, 4, 0}, {0, -3, 0}}, {0, 1, 1, 2});
    expect_tail("below a joint at the same place the next one counts", {0, 2, 0}, "a",
                {{"a", -1, {0, 0, 0}}, {"twist", 0, {0, 0, 0}}, {"b", 1, {0, 2, 0}}}, upwards, {0, 1, 2});
    // The middle of the leaf's points is at (0, 5, 0), so that it points along y; the farthest one is 4 along y.
    expect_tail("a leaf ends at nine tenths of the way to its farthest point", {0, 2 + 0.9 * 4, 0}, "b",
                {{"a", -1, {0, 0, 0}}, {"b", 0, {0, 2, 0}}}, {{0, 1, 0}, {1, 4, 0}, {-1, 6, 0}}, {0, 1, 1});
    expect_tail("a leaf whose points say nothing goes on as its parent, by three tenths of its length",
                {3 + 0.3 * 3, 0, 0}, "b", {{"a", -1, {0, 0, 0}}, {"b", 0, {3, 0, 0}}},
                {{0, 1, 0}, {0, -1, 0}, {3, 0, 0}}, {0, 0, 1});
}

TEST(BoneTails, ANodeWithAMeshIsNoJointBelow)
{
    Rig rig = rig_with({{"a", -1, {0, 0, 0}}, {"b", 0, {0, 2, 0}}}, {{0, 1, 0}, {0, 2, 0}, {0, 4, 0}}, {0, 1, 1});
    rig.nodes[2].parent = 0;
    rig.nodes[2].rest.translation = Vec3(6, 0, 0);
    EXPECT_LE((tail_of("a", rig) - Vec3(0, 2, 0)).norm(), tail_rounding);
}

TEST(BoneTails, PointsThatOthersMoveMoreDoNotLengthenALeaf)
{
    Rig rig = rig_with({{"a", -1, {0, 0, 0}}, {"b", 0, {0, 2, 0}}}, {{0, 1, 0}, {0, 6, 0}, {0, 9, 0}}, {0, 1, 0});
    rig.meshes[0].skin.first = {0, 1, 2, 4};
    rig.meshes[0].skin.bone = {0, 1, 0, 1};
    rig.meshes[0].skin.weight = {1.0, 1.0, 0.75, 0.25};
    EXPECT_LE((tail_of("b", rig) - Vec3(0, 2 + 0.9 * 4, 0)).norm(), tail_rounding);
}

TEST(BoneTails, ASingleJointAmongItsPointsStillHasALength)
{
    const Rig rig = rig_with({{"a", -1, {0, 0, 0}}}, {{1, 0, 0}, {-1, 0, 0}, {0, 0, 1}, {0, 0, -1}}, {0, 0, 0, 0});
    EXPECT_GT(tail_of("a", rig).norm(), 0.1);
    EXPECT_TRUE(tail_of("a", rig).allFinite());
}

TEST(BoneTails, AreThoseOfTheBindPoseNotOfTheRestPose)
{
    Rig rig = rig_with({{"a", -1, {0, 0, 0}}, {"b", 0, {0, 2, 0}}, {"end", 1, {0, 4, 0}}},
                       {{0, 1, 0}, {0, 2, 0}, {0, 4, 0}}, {0, 1, 1});
    rig.nodes[1].rest.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(M_PI / 2.0, Vec3::UnitZ()));
    EXPECT_LE((tail_of("b", rig) - Vec3(0, 4, 0)).norm(), tail_rounding);
    rig.meshes[0].joints.pop_back();  // `end` is no joint of the skin: it keeps its place relative to b
    EXPECT_LE((tail_of("b", rig) - Vec3(0, 4, 0)).norm(), tail_rounding);
}

// Tails move with a body that is moved as a whole, and grow with it.
TEST(BoneTails, MoveAndScaleWithTheRig)
{
    for (const double scale : {1e-6, 1.0, 1e6}) {
        const Rig rig = rig_with({{"a", -1, scale * Vec3(5, 0, 0)}, {"b", 0, scale * Vec3(5, 2, 0)}},
                                 {scale * Vec3(5, 1, 0), scale * Vec3(6, 4, 0), scale * Vec3(4, 6, 0)}, {0, 1, 1});
        EXPECT_LE((tail_of("b", rig) / scale - Vec3(5, 5.6, 0)).norm(), 2.0 * tail_rounding) << scale;
    }
}

}  // namespace

// Reference: forward kinematics of a straight chain, by hand. Tolerances: the rounding of a motion per joint.
#include "pbs/geometry/input_error.hpp"
#include "pbs/skinning/pose.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace pose_tests {
namespace {

// Reference: the bones that meet at each point, read from the drawing.

using pbs::BoneEnd;
using Indices = std::vector<int>;

// A pelvis with two hips that start at its head, a spine that starts at its tail, and a thigh on the left hip.
pbs::Skeleton body()
{
    return {{{"pelvis", -1, {0, 1, 0}, {0, 1.2, 0}},
             {"spine", 0, {0, 1.2, 0}, {0, 1.6, 0}},
             {"hip.L", 0, {0, 1, 0}, {-0.1, 0.95, 0}},
             {"hip.R", 0, {0, 1, 0}, {0.1, 0.95, 0}},
             {"thigh.L", 2, {-0.1, 0.95, 0}, {-0.1, 0.5, 0}}}};
}

// One pose that parts two bones is enough; a motion of the whole body parts none, nor does a thousandth of its size.
TEST(BonesThatMoveAsOne, AreThoseThatNoPoseMovesApart)
{
    const pbs::Pose rest(5, Eigen::Isometry3d::Identity());
    pbs::Pose moved = rest, spine_turned = rest, thigh_shifted = rest;
    for (Eigen::Isometry3d& bone : moved)
        bone = Eigen::Translation3d(0.0, 3.0, 0.0) * Eigen::AngleAxisd(1.0, pbs::Vec3::UnitX());
    spine_turned[1].rotate(Eigen::AngleAxisd(0.002, pbs::Vec3::UnitZ()));
    for (const auto& [shift, own] : {std::pair(0.0009, 0), std::pair(0.0011, 4)}) {
        thigh_shifted[4].translation() = pbs::Vec3(2.0 * shift, 0.0, 0.0);
        EXPECT_EQ(pbs::bones_that_move_as_one(body(), {rest, moved, thigh_shifted, spine_turned}, 2.0),
                  (Indices{0, 1, 0, 0, own}));
    }
    EXPECT_EQ(pbs::bones_that_move_as_one(body(), {rest, moved}, 2.0), Indices(5, 0));
}

TEST(FindBone, ByName)
{
    EXPECT_EQ(pbs::find_bone(body(), "hip.R"), 3);
    EXPECT_EQ(pbs::find_bone(body(), "tail"), -1);
}

TEST(BonesMeeting, AreThoseThatShareTheEnd)
{
    const pbs::Skeleton single = {{{"only", -1, {0, 0, 0}, {1, 0, 0}}}};
    const pbs::Skeleton with_point = {
        {{"a", -1, {0, 0, 0}, {1, 0, 0}}, {"point", 0, {1, 0, 0}, {1, 0, 0}}, {"c", 1, {1, 0, 0}, {2, 0, 0}}}};
    const auto child_at = [](double y) -> pbs::Skeleton {
        return {{{"a", -1, {0, 0, 0}, {1, 0, 0}}, {"b", 0, {1, y, 0}, {1, 0, 0}}}};
    };
    struct Case {
        const char* name;
        pbs::Skeleton skeleton;
        int bone;
        BoneEnd end;
        Indices expected;
    };
    const Case cases[] = {
        {"at a head: parent and siblings that start there", body(), 2, BoneEnd::head, {2, 0, 3}},
        {"siblings that start elsewhere are left out", body(), 1, BoneEnd::head, {1, 0}},
        {"at a tail: children that start there", body(), 0, BoneEnd::tail, {0, 1}},
        {"at the tail of a child", body(), 2, BoneEnd::tail, {2, 4}},
        {"at a root's head: children that start there", body(), 0, BoneEnd::head, {0, 2, 3}},
        {"at a free end: the bone alone", body(), 4, BoneEnd::tail, {4}},
        {"within two percent of the diagonal", child_at(0.019), 0, BoneEnd::tail, {0, 1}},
        {"farther away", child_at(0.021), 0, BoneEnd::tail, {0}},
        {"the head of a single bone", single, 0, BoneEnd::head, {0}},
        {"the tail of a single bone", single, 0, BoneEnd::tail, {0}},
        {"a bone of length zero", with_point, 1, BoneEnd::head, {1, 0, 2}},
    };
    for (const auto& [name, skeleton, bone, end, expected] : cases)
        EXPECT_EQ(pbs::bones_meeting(skeleton, bone, end), expected) << name;
}

using pbs::Vec3;

const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();

pbs::Skeleton chain()
{
    return {{{"a", -1, {0, 0, 0}, {1, 0, 0}}, {"b", 0, {1, 0, 0}, {2, 0, 0}}, {"c", 1, {2, 0, 0}, {3, 0, 0}}}};
}

Eigen::Quaterniond turn(double angle_deg, const Vec3& axis)
{
    return Eigen::Quaterniond(Eigen::AngleAxisd(angle_deg * std::numbers::pi / 180.0, axis));
}

TEST(PoseFromJoints, WithoutRotationIsTheIdentityExactly)
{
    const pbs::Pose pose = pbs::pose_from_joints(chain(), std::vector(3, Eigen::Quaterniond::Identity()), Vec3::Zero());
    for (const Eigen::Isometry3d& bone : pose) EXPECT_EQ(bone.matrix(), Eigen::Matrix4d::Identity());
}

TEST(PoseFromJoints, ComposesDownTheChain)
{
    const pbs::Pose pose = pbs::pose_from_joints(chain(), {turn(90, z), turn(-90, z), turn(90, x)}, Vec3(0, 0, 5));
    EXPECT_LT((pose[0] * Vec3(1, 0, 0) - Vec3(0, 1, 5)).norm(), test_support::motion_error(1, 6.0));
    EXPECT_LT((pose[1] * Vec3(2, 0, 0) - Vec3(1, 1, 5)).norm(), test_support::motion_error(2, 6.0));
    EXPECT_LT((pose[2] * Vec3(2, 1, 0) - Vec3(1, 1, 6)).norm(), test_support::motion_error(3, 6.5));
}

TEST(PoseFromJoints, KeepsJointsTogether)
{
    const pbs::Skeleton skeleton = chain();
    const pbs::Pose pose =
        pbs::pose_from_joints(skeleton, {turn(33, y), turn(-71, x + z), turn(120, y)}, Vec3(1, 2, 3));
    for (int j = 1; j < 3; ++j)  // j motions to the parent's end, and one more to the head
        EXPECT_LT((pose[j] * skeleton.bones[j].head - pose[j - 1] * skeleton.bones[j].head).norm(),
                  test_support::motion_error(2 * j + 1, 6.0));
}

TEST(JointSweep, RunsFromRestToTheAngle)
{
    const pbs::Motion motion = pbs::joint_sweep(chain(), 1, 2.0 * z, 90.0, 4, 0.02);
    ASSERT_EQ(motion.frames(), 4);
    EXPECT_EQ(motion.angle_deg, (std::vector{0.0, 30.0, 60.0, 90.0}));
    EXPECT_EQ(motion.time_step_s, 0.02);
    for (const Eigen::Isometry3d& bone : motion.steps[0]) EXPECT_EQ(bone.matrix(), Eigen::Matrix4d::Identity());
    EXPECT_EQ(motion.steps[3][0].matrix(), Eigen::Matrix4d::Identity());
    EXPECT_LT((motion.steps[3][1] * Vec3(2, 0, 0) - Vec3(1, 1, 0)).norm(), test_support::motion_error(2, 2.0));
    EXPECT_LT((motion.steps[3][2] * Vec3(3, 0, 0) - Vec3(1, 2, 0)).norm(), test_support::motion_error(3, 3.0));
}

TEST(JointSweep, OfOneFrameIsTheRestPose)
{
    const pbs::Motion motion = pbs::joint_sweep(chain(), 1, z, 90.0, 1, 0.01);
    ASSERT_EQ(motion.frames(), 1);
    EXPECT_EQ(motion.steps[0][1].matrix(), Eigen::Matrix4d::Identity());
}

TEST(JointSweep, RefusesBadInput)
{
    EXPECT_THROW(pbs::joint_sweep(chain(), 3, z, 90.0, 4, 0.01), pbs::InputError);
    EXPECT_THROW(pbs::joint_sweep(chain(), -1, z, 90.0, 4, 0.01), pbs::InputError);
    EXPECT_THROW(pbs::joint_sweep(chain(), 1, Vec3::Zero(), 90.0, 4, 0.01), pbs::InputError);
    EXPECT_THROW(pbs::joint_sweep(chain(), 1, z, 90.0, 0, 0.01), pbs::InputError);
}

TEST(Motion, CountsFramesBySteps)
{
    pbs::Motion motion;
    EXPECT_EQ(motion.frames(), 0);
    motion.steps.resize(9);
    motion.steps_per_frame = 4;
    EXPECT_EQ(motion.frames(), 3);
}

}  // namespace
}  // namespace pose_tests

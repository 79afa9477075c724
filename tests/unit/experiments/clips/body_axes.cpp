// Reference: a body of 13 joints at places that are written down here, turned by known rotations.
#include "experiments/clips/body_axes.hpp"
#include "tests/unit/experiments/characters/expect_input_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace pbs;

enum {
    hips,
    neck,
    head,
    arm_l,
    elbow_l,
    hand_l,
    arm_r,
    elbow_r,
    hand_r,
    thigh_l,
    knee_l,
    foot_l,
    thigh_r,
    knee_r,
    foot_r,
    joint_count
};
const std::vector<std::string> names = {"Hips",     "Neck",     "Head",         "LeftArm",   "LeftForeArm",
                                        "LeftHand", "RightArm", "RightForeArm", "RightHand", "LeftUpLeg",
                                        "LeftLeg",  "LeftFoot", "RightUpLeg",   "RightLeg",  "RightFoot"};
const std::vector<int> parents = {-1,      hips, neck,    neck,   arm_l, elbow_l, neck,  arm_r,
                                  elbow_r, hips, thigh_l, knee_l, hips,  thigh_r, knee_r};

Eigen::Matrix3d about(const Vec3& axis, double deg)
{
    return Eigen::AngleAxisd(deg * M_PI / 180.0, axis).toRotationMatrix();
}

// y up, faces z; the arms hang by so many degrees from the side.
Positions body(double arms_deg = 0.0)
{
    Positions points(joint_count, 3);
    const double c = std::cos(arms_deg * M_PI / 180.0), s = std::sin(arms_deg * M_PI / 180.0);
    points << 0, 1.0, 0, 0, 1.5, 0, 0, 1.6, 0, 0.2, 1.4, 0, 0.2 + 0.3 * c, 1.4 - 0.3 * s, 0, 0.2 + 0.5 * c,
        1.4 - 0.5 * s, 0, -0.2, 1.4, 0, -0.2 - 0.3 * c, 1.4 - 0.3 * s, 0, -0.2 - 0.5 * c, 1.4 - 0.5 * s, 0, 0.1, 0.9, 0,
        0.1, 0.5, 0, 0.1, 0.1, 0, -0.1, 0.9, 0, -0.1, 0.5, 0, -0.1, 0.1, 0;
    return points;
}

BodyJoints joints()
{
    return {.chest = -1,
            .neck = neck,
            .head = head,
            .upper_arm = {arm_l, arm_r},
            .forearm = {elbow_l, elbow_r},
            .hand = {hand_l, hand_r},
            .thigh = {thigh_l, thigh_r},
            .shin = {knee_l, knee_r},
            .foot = {foot_l, foot_r}};
}

Positions turned(const Positions& points, const Eigen::Matrix3d& turn)
{
    return points * turn.transpose();
}

Eigen::Matrix3d axes_of(const Positions& points)
{
    return body_axes(trunk_directions(points, joints()).value());
}

TEST(BodyAxes, AreThoseInWhichTheBodyStands)
{
    EXPECT_EQ(axes_of(body()), Eigen::Matrix3d(Eigen::Matrix3d::Identity()));
    for (const Vec3& axis : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitY()), Vec3(Vec3::UnitZ())})
        for (const double deg : {90.0, 180.0, -90.0})
            EXPECT_LT((axes_of(turned(body(), about(axis, deg))) - about(axis, deg)).cwiseAbs().maxCoeff(), 1e-12)
                << deg;
}

TEST(BodyAxes, FollowAnyHeadingAndNoLeanOrAsymmetry)
{
    EXPECT_LT((axes_of(turned(body(), about(Vec3::UnitY(), 35.0))) - about(Vec3::UnitY(), 35.0)).cwiseAbs().maxCoeff(),
              1e-12);
    EXPECT_EQ(axes_of(turned(body(), about(Vec3::UnitX(), 12.0))), Eigen::Matrix3d(Eigen::Matrix3d::Identity()));
    EXPECT_EQ(axes_of(turned(body(), about(Vec3::UnitY(), 3.0))), Eigen::Matrix3d(Eigen::Matrix3d::Identity()));
}

TEST(BodyAxes, AreUnknownWhereTheTrunkIsNone)
{
    Positions line = body();
    line.col(0).setZero();
    EXPECT_FALSE(trunk_directions(line, joints()));
    EXPECT_FALSE(trunk_directions(Positions::Zero(joint_count, 3), joints()));
    EXPECT_FALSE(trunk_directions(body(), {}));
}

TEST(RestPose, ATOrAPoseHasStraightLegsAndArmsAtTheSides)
{
    for (const double arms_deg : {-15.0, 0.0, 30.0, 60.0})
        EXPECT_TRUE(is_t_or_a_pose(body(arms_deg), joints())) << arms_deg;
    for (const double arms_deg : {-45.0, 85.0}) EXPECT_FALSE(is_t_or_a_pose(body(arms_deg), joints())) << arms_deg;
    Positions sits = body();
    for (const int foot : {foot_l, foot_r}) sits.row(foot) += Eigen::RowVector3d(0, 0.4, 0.4);
    EXPECT_FALSE(is_t_or_a_pose(sits, joints()));
    EXPECT_FALSE(is_t_or_a_pose(body(), {}));
}

Clip still_clip(const Positions& zero_pose, const Positions& first)
{
    Clip clip;
    clip.name = "walk.bvh";
    clip.frame_time_s = 0.1;
    clip.joints = names;
    clip.parent = parents;
    clip.zero_pose = zero_pose;
    clip.places = {first, first};
    clip.local.assign(2, std::vector<Eigen::Quaterniond>(joint_count, Eigen::Quaterniond::Identity()));
    return clip;
}

// As in clips with frames along the bones: the legs continue the trunk upwards.
Positions along_one_axis()
{
    Positions points = body();
    for (const int joint : {knee_l, foot_l, knee_r, foot_r}) points(joint, 1) = 1.8 - points(joint, 1);
    return points;
}

TEST(RestPose, IsTheZeroPoseOrATPoseInTheFirstFrame)
{
    Positions hands_up = body(-60.0);
    EXPECT_EQ(rest_frame(still_clip(body(), hands_up), joints()), -1);
    EXPECT_EQ(rest_frame(still_clip(along_one_axis(), body(20.0)), joints()), 0);
    EXPECT_EQ(rest_frame(still_clip(hands_up, hands_up), joints()), -1) << "no T pose, but a body's";
    EXPECT_EQ(rest_frame(still_clip(along_one_axis(), hands_up), {}), -1) << "unknown parts";
    expect_input_error([&] { rest_frame(still_clip(along_one_axis(), hands_up), joints()); },
                       "walk.bvh: rest pose: cannot be known", "legs that point 180 degrees");
}

TEST(RestPose, InFrontOfAClipIsNoFrameOfItsMotion)
{
    Clip clip = still_clip(body(), body(-60.0));
    EXPECT_EQ(first_frame_of_motion(clip), 1) << "without a turn, whatever the pose";
    clip.local.front()[elbow_l] = Eigen::AngleAxisd(0.01, Vec3::UnitX());
    EXPECT_EQ(first_frame_of_motion(clip), 0);
    clip.places.front() = body(20.0);
    EXPECT_EQ(first_frame_of_motion(clip), 1) << "an A pose of turned joints";
    clip.joints.assign(joint_count, "joint");
    EXPECT_EQ(first_frame_of_motion(clip), 0) << "unknown parts";
}

Skeleton skeleton_of(const Positions& points)
{
    Skeleton skeleton;
    for (int j = 0; j < joint_count; ++j)
        skeleton.bones.push_back({names[j], parents[j], points.row(j), points.row(j) + Eigen::RowVector3d(0, 0, 0.01)});
    return skeleton;
}

TEST(AxesOfClipToSkeleton, CarryOneBodyIntoTheOther)
{
    const Eigen::Matrix3d clip_turn = about(Vec3::UnitX(), 90.0), model_turn = about(Vec3::UnitY(), 140.0);
    const Skeleton skeleton = skeleton_of(turned(body(30.0), model_turn));
    const Clip clip = still_clip(turned(body(), clip_turn), body());
    const JointMap map = joint_map(clip, skeleton);
    const Eigen::Matrix3d axes = axes_of_clip_to_skeleton(clip.zero_pose, skeleton, map);
    EXPECT_LT((axes - model_turn * clip_turn.transpose()).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(AxesOfClipToSkeleton, OfAnotherCreatureAreThoseOfTheSameRig)
{
    const Skeleton skeleton = skeleton_of(body());
    JointMap map;
    for (int j = 0; j < joint_count; ++j) map.bones.push_back({.joint = j});
    const Eigen::Matrix3d turn = about(Vec3(1, 2, 3).normalized(), 70.0);
    EXPECT_LT((axes_of_clip_to_skeleton(turned(body(), turn), skeleton, map) - turn.transpose()).cwiseAbs().maxCoeff(),
              1e-12);
    Positions other = turned(body(), turn);
    other.row(head) *= 3.0;
    EXPECT_EQ(axes_of_clip_to_skeleton(other, skeleton, map), Eigen::Matrix3d(Eigen::Matrix3d::Identity()))
        << "another rig";
}

TEST(CheckTrunk, ABodyThatLiesOrFacesAwayIsRefused)
{
    const Skeleton skeleton = skeleton_of(body());
    const Clip clip = still_clip(body(), body());
    const JointMap map = joint_map(clip, skeleton);
    EXPECT_NO_THROW(check_trunk(clip, map, turned(body(), about(Vec3::UnitX(), 29.0)), body()));
    const auto refused = [&](const Eigen::Matrix3d& turn, const std::string& direction) {
        expect_input_error([&] { check_trunk(clip, map, turned(body(), turn), body()); },
                           "walk.bvh: direction " + direction, "expected at most 30");
    };
    refused(about(Vec3::UnitX(), 45.0), "from the hips to the neck = 45 degrees between the clip and the body");
    refused(about(Vec3::UnitY(), 90.0), "from hip to hip = 90 degrees between the clip and the body");
}

}  // namespace

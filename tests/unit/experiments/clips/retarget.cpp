// Reference: invented clips whose poses are known in closed form. Tolerances: the rounding of rotations, six per bone:
// that of the clip, slerp, its place in the world, the alignment, its place in the parent, and the rotation of the
// pose.

#include "experiments/clips/clip.hpp"
#include "pbs/geometry/input_error.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/unit/experiments/characters/expect_input_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace retarget_tests {
namespace {

using namespace pbs;

const Skeleton limb{{{"upper", -1, Vec3(-1, 0, 0), Vec3(0, 0, 0)}, {"forearm", 0, Vec3(0, 0, 0), Vec3(1, 0, 0)}}};

// The places of all joints in each frame, whose root goes along `path`, #frames x 3.
void place_joints(Clip& clip, const Positions& path)
{
    clip.places.assign(static_cast<std::size_t>(clip.frames()), clip.zero_pose);
    for (std::size_t frame = 0; frame < clip.places.size(); ++frame) {
        std::vector<Eigen::Quaterniond> turns;
        Positions& places = clip.places[frame];
        for (std::size_t j = 0; j < clip.joints.size(); ++j) {
            const int above = clip.parent[j];
            turns.push_back(above < 0 ? clip.local[frame][j] : turns[above] * clip.local[frame][j]);
            if (above < 0) places.row(j) = path.row(frame);
            if (above >= 0)
                places.row(j) = places.row(above) +
                                (turns[above] * Vec3(clip.zero_pose.row(j) - clip.zero_pose.row(above))).transpose();
        }
    }
}

// A chain of joints, `spacing` apart, whose root stays; those of which `turns` is true turn by `degrees` per frame
// about z.
Clip chain_of(const std::vector<std::string>& joints, const std::vector<bool>& turns, double degrees = 10.0,
              int frames = 3, const Vec3& spacing = Vec3::UnitX())
{
    Clip clip;
    clip.name = "chain.bvh";
    clip.frame_time_s = 0.01;
    clip.joints = joints;
    clip.zero_pose.resize(Eigen::Index(joints.size()), 3);
    for (int j = 0; j < int(joints.size()); ++j) {
        clip.parent.push_back(j - 1);
        clip.zero_pose.row(j) = j * spacing;
    }
    for (int frame = 0; frame < frames; ++frame) {
        clip.local.emplace_back();
        for (const bool turn : turns)
            clip.local.back().emplace_back(
                Eigen::AngleAxisd(turn ? frame * degrees * M_PI / 180.0 : 0.0, Vec3::UnitZ()));
    }
    place_joints(clip, Positions::Zero(frames, 3));
    return clip;
}

// upper -> forearm -> hand along `direction`, bones 2 units long. Frame f turns the forearm by 10 f degrees about z and
// moves the root by f along y.
Clip bending_clip(int frames, const Vec3& direction = Vec3::UnitX())
{
    Clip clip = chain_of({"upper", "forearm", "hand"}, {false, true, false}, 10.0, frames, 2.0 * direction);
    clip.name = "bending.bvh";
    Positions path = Positions::Zero(frames, 3);
    for (int frame = 0; frame < frames; ++frame) path(frame, 1) = frame;
    place_joints(clip, path);
    return clip;
}

ClipSampling whole_clip()
{
    ClipSampling sampling;
    sampling.drops_rest_pose = false;
    return sampling;
}

const double of_rotations = test_support::motion_error(6, 1.0), of_angles_deg = of_rotations * 180.0 / M_PI;

double angle_about_z_deg(const Eigen::Isometry3d& bone)
{
    return std::atan2(bone.linear()(1, 0), bone.linear()(0, 0)) * 180.0 / M_PI;
}

TEST(Retarget, EqualNamesTakeTheRotations)
{
    const Motion motion = retarget(bending_clip(5), limb, whole_clip());
    ASSERT_EQ(motion.steps.size(), 5u);
    EXPECT_EQ(motion.frames(), 5);
    for (int frame = 0; frame < 5; ++frame) {
        EXPECT_NEAR(angle_about_z_deg(motion.steps[frame][0]), 0.0, of_angles_deg);
        EXPECT_NEAR(angle_about_z_deg(motion.steps[frame][1]), 10.0 * frame, of_angles_deg);
    }
}

TEST(Retarget, TheRootsPathIsScaledByBoneLengthAndStartsAtRest)
{
    const Motion motion = retarget(bending_clip(5), limb, whole_clip());
    // Bones of 1 m follow limbs of 2 units. A place on the path of 2 m goes through eight roundings, and the root
    // rotates about its head.
    const double rounding_m = test_support::rounding_error(8, 2.0) + of_rotations;
    for (int frame = 0; frame < 5; ++frame)
        EXPECT_LT((motion.steps[frame][0].translation() - Vec3(0.0, 0.5 * frame, 0.0)).norm(), rounding_m);
}

TEST(Retarget, TheDroppedFrameIsNotTheFirst)
{
    ClipSampling sampling;
    const Motion motion = retarget(bending_clip(5), limb, sampling);
    ASSERT_EQ(motion.steps.size(), 4u);
    EXPECT_NEAR(angle_about_z_deg(motion.steps[0][1]), 10.0, of_angles_deg);
    EXPECT_LT(motion.steps[0][0].translation().norm(), of_rotations);
}

TEST(Retarget, AFirstFrameInMotionIsKept)
{
    Clip clip = bending_clip(5);
    clip.local.erase(clip.local.begin());
    clip.places.erase(clip.places.begin());
    const Motion motion = retarget(clip, limb, ClipSampling{});
    ASSERT_EQ(motion.steps.size(), 4u);
    EXPECT_NEAR(angle_about_z_deg(motion.steps[0][1]), 10.0, of_angles_deg);
}

TEST(Retarget, AlignsTheRestDirections)
{
    // The clip's zero pose points along y. At frame 0 our bones, which point along x at rest, must point along y too.
    const Motion motion = retarget(bending_clip(3, Vec3::UnitY()), limb, whole_clip());
    for (int frame = 0; frame < 3; ++frame) {
        const double turned = frame * M_PI / 18.0;
        const Vec3 forearm = motion.steps[frame][1].linear() * Vec3::UnitX();
        EXPECT_LT((forearm - Vec3(-std::sin(turned), std::cos(turned), 0.0)).norm(), of_rotations);
        EXPECT_LT((motion.steps[frame][0].linear() * Vec3::UnitX() - Vec3::UnitY()).norm(), of_rotations);
    }
}

TEST(Retarget, BonesStayJoined)
{
    const Motion motion = retarget(bending_clip(7, Vec3(1, 2, 3).normalized()), limb, whole_clip());
    const double rounding_m = test_support::motion_error(6 + 6, 4.0 + 1.0);  // of two bones on a path of less than 4 m
    for (const Pose& pose : motion.steps)
        EXPECT_LT((pose[0] * limb.bones[0].tail - pose[1] * limb.bones[1].head).norm(), rounding_m);
}

TEST(Retarget, SlerpsBetweenFramesOnTheGridOfTheSteps)
{
    ClipSampling sampling = whole_clip();
    sampling.start_s = 0.005;
    sampling.duration_s = 0.02;
    sampling.time_step_s = 0.0025;
    const Motion motion = retarget(bending_clip(5), limb, sampling);
    ASSERT_EQ(motion.steps.size(), 9u);
    EXPECT_EQ(motion.steps_per_frame, 4);
    EXPECT_EQ(motion.frames(), 3);
    for (int step = 0; step < 9; ++step)
        EXPECT_NEAR(angle_about_z_deg(motion.steps[step][1]), 5.0 + 2.5 * step, of_angles_deg);
}

TEST(Retarget, BonesWithoutAJointFollowTheirParent)
{
    Skeleton longer = limb;
    longer.bones.push_back({"finger", 1, Vec3(1, 0, 0), Vec3(1.2, 0, 0)});
    const Motion motion = retarget(bending_clip(5), longer, whole_clip());
    // the finger's place in its parent and its rotation
    const double rounding = test_support::motion_matrix_error(2, 2.0 + 1.0);
    EXPECT_LT((motion.steps[4][2].matrix() - motion.steps[4][1].matrix()).norm(), rounding);
}

TEST(Retarget, BranchingJointsAreNotAligned)
{
    Clip clip = bending_clip(2, Vec3::UnitY());
    clip.joints.push_back("other");
    clip.parent.push_back(0);
    clip.zero_pose.conservativeResize(4, 3);
    clip.zero_pose.row(3) << 1, 0, 0;
    for (auto& local : clip.local) local.push_back(Eigen::Quaterniond::Identity());
    place_joints(clip, Positions::Zero(2, 3));
    EXPECT_EQ(Eigen::Matrix3d(retarget(clip, limb, whole_clip()).steps[0][0].linear()),
              Eigen::Matrix3d(Eigen::Matrix3d::Identity()));
}

TEST(Retarget, ThePathIsThatOfTheJointThatMovesTheRootBone)
{
    Clip clip =
        chain_of({"reference", "upper", "forearm", "hand"}, {false, false, true, false}, 10.0, 3, 2.0 * Vec3::UnitX());
    for (int frame = 0; frame < 3; ++frame) {
        clip.places[frame].bottomRows(3).rowwise() += Eigen::RowVector3d(0.0, 0.0, frame);
        clip.local[frame][0] = Eigen::AngleAxisd(0.0, Vec3::UnitX());
    }
    const Motion motion = retarget(clip, limb, whole_clip());
    const double rounding_m = test_support::rounding_error(8, 6.0) + of_rotations;
    for (int frame = 0; frame < 3; ++frame)  // bones of 1 m follow limbs of 2 units
        EXPECT_LT((motion.steps[frame][0].translation() - Vec3(0.0, 0.0, 0.5 * frame)).norm(), rounding_m);
}

TEST(Retarget, JointsWhoseKeysAreStepsHoldTheirTurn)
{
    Clip clip = bending_clip(3);
    clip.holds = {false, true, false};
    ClipSampling sampling = whole_clip();
    sampling.time_step_s = 0.0025;
    const Motion motion = retarget(clip, limb, sampling);
    ASSERT_EQ(motion.steps.size(), 9u);
    for (int step = 0; step < 9; ++step)
        EXPECT_NEAR(angle_about_z_deg(motion.steps[step][1]), 10.0 * (step / 4), of_angles_deg) << step;
}

TEST(Retarget, RefusesWhatItCannotDo)
{
    const auto refused = [](const std::function<void(ClipSampling&, Clip&)>& spoil, const std::string& begins,
                            const std::string& holds) {
        Clip clip = bending_clip(5);
        ClipSampling sampling = whole_clip();
        spoil(sampling, clip);
        expect_input_error([&] { retarget(clip, limb, sampling); }, begins, holds);
    };
    refused([](auto& s, auto&) { s.start_s = -1.0; }, "bending.bvh: start_s = -1", "lasts 0.04");
    refused([](auto& s, auto&) { s.start_s = 0.05; }, "bending.bvh: start_s = 0.05", "lasts 0.04");
    refused([](auto& s, auto&) { s.start_s = std::nan(""); }, "bending.bvh: start_s = nan", "lasts");
    refused([](auto& s, auto&) { s.duration_s = 0.05; }, "bending.bvh: duration_s = 0.05", "ends at 0.04");
    refused([](auto& s, auto&) { s.rate_hz = 0.0; }, "rate_hz = 0", "> 0");
    refused([](auto& s, auto&) { s.time_step_s = 0.0; }, "time_step_s = 0", "> 0");
    refused([](auto& s, auto&) { s.time_step_s = 0.015; }, "rate_hz * time_step_s = 1.5", "1 / n");
    refused([](auto& s, auto&) { s.time_step_s = 0.004; }, "rate_hz * time_step_s = 0.4", "1 / n");
    refused([](auto& s, auto& c) { c = bending_clip(1), s.drops_rest_pose = true; }, "bending.bvh: Frames = 1",
            "no frame is left");
    refused(
        [](auto&, auto& c) {
            c.joints = {"a", "b", "c"};
        },
        "bending.bvh: joints = a, b, c: ", "(bones: upper, forearm)");
}

// Reference: clips of three joints, counted by hand.

TEST(ClipMatch, CountsTheJointsThatMoveAndThoseThatABoneFollows)
{
    const ClipMatch match = match_of(chain_of({"upper", "forearm", "hand", "end"}, {true, true, true, false}), limb);
    EXPECT_EQ(match.moving, 3);
    EXPECT_EQ(match.matched, 2);
    EXPECT_EQ(match.unmatched, std::vector<std::string>{"hand"});
    const ClipMatch resting = match_of(chain_of({"upper", "forearm", "hand"}, {false, true, false}), limb);
    EXPECT_EQ(resting.moving, 1);
    EXPECT_EQ(resting.matched, 1);
    EXPECT_TRUE(resting.unmatched.empty());
}

TEST(ClipMatch, ARotationOfSinglePrecisionAndANegativeQuaternionAreNoMotion)
{
    EXPECT_EQ(match_of(chain_of({"upper", "forearm", "hand"}, {true, true, true}, 1e-4), limb).moving, 0);
    Clip clip = chain_of({"upper", "forearm", "hand"}, {false, false, false});
    clip.local[1][1].coeffs() *= -1.0;
    EXPECT_EQ(match_of(clip, limb).moving, 0);
}

TEST(ClipMatch, AClipNoneOfWhoseNamesMatchesIsRefused)
{
    EXPECT_THROW(match_of(chain_of({"a", "b", "c"}, {true, true, true}), limb), InputError);
}

TEST(LargestRotation, IsThatOfAnyBoneFromTheFirstPose)
{
    Motion motion;
    for (const double degrees : {10.0, 130.0, 40.0}) {
        Pose pose(2, Eigen::Isometry3d::Identity());
        pose[1].linear() = Eigen::AngleAxisd(degrees * M_PI / 180.0, Vec3::UnitX()).toRotationMatrix();
        pose[0].translation() = Vec3(degrees, 0, 0);
        motion.steps.push_back(pose);
    }
    EXPECT_NEAR(largest_rotation_deg(motion), 120.0, 1e-9);
    motion.steps.resize(1);
    EXPECT_EQ(largest_rotation_deg(motion), 0.0);
    EXPECT_EQ(largest_rotation_deg(Motion{}), 0.0);
}

}  // namespace
}  // namespace retarget_tests

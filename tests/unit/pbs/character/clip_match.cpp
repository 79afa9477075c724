// Reference: clips of three joints, counted by hand.
#include "pbs/character/clip_match.hpp"

#include "pbs/geometry/input_error.hpp"

#include <gtest/gtest.h>

namespace {

using namespace pbs;

const Skeleton arm_to_match{{{"upper", -1, Vec3(-1, 0, 0), Vec3(0, 0, 0)}, {"forearm", 0, Vec3(0, 0, 0), Vec3(1, 0, 0)}}};

// A chain of joints along x; those of which `turns` is true turn by 10 degrees per frame about z.
Clip chain_of(const std::vector<std::string>& joints, const std::vector<bool>& turns, double degrees = 10.0)
{
    Clip clip;
    clip.name = "chain.bvh";
    clip.frame_time_s = 0.01;
    clip.joints = joints;
    clip.zero_pose.resize(Eigen::Index(joints.size()), 3);
    for (int j = 0; j < int(joints.size()); ++j) {
        clip.parent.push_back(j - 1);
        clip.zero_pose.row(j) << j, 0, 0;
    }
    clip.root = Positions::Zero(3, 3);
    for (int frame = 0; frame < 3; ++frame) {
        clip.local.emplace_back();
        for (const bool turn : turns)
            clip.local.back().emplace_back(Eigen::AngleAxisd(turn ? frame * degrees * M_PI / 180.0 : 0.0, Vec3::UnitZ()));
    }
    return clip;
}

TEST(ClipMatch, CountsTheJointsThatMoveAndThoseThatABoneFollows)
{
    const ClipMatch match = match_of(chain_of({"upper", "forearm", "hand", "end"}, {true, true, true, false}), arm_to_match);
    EXPECT_EQ(match.moving, 3);
    EXPECT_EQ(match.matched, 2);
    EXPECT_EQ(match.unmatched, std::vector<std::string>{"hand"});
}

TEST(ClipMatch, AJointThatRestsIsNotCounted)
{
    const ClipMatch match = match_of(chain_of({"upper", "forearm", "hand"}, {false, true, false}), arm_to_match);
    EXPECT_EQ(match.moving, 1);
    EXPECT_EQ(match.matched, 1);
    EXPECT_TRUE(match.unmatched.empty());
}

TEST(ClipMatch, ARotationOfSinglePrecisionIsNone)
{
    EXPECT_EQ(match_of(chain_of({"upper", "forearm", "hand"}, {true, true, true}, 1e-4), arm_to_match).moving, 0);
}

TEST(ClipMatch, AQuaternionAndItsNegativeAreOneRotation)
{
    Clip clip = chain_of({"upper", "forearm", "hand"}, {false, false, false});
    clip.local[1][1].coeffs() *= -1.0;
    EXPECT_EQ(match_of(clip, arm_to_match).moving, 0);
}

TEST(ClipMatch, AClipNoneOfWhoseNamesMatchesIsRefused)
{
    EXPECT_THROW(match_of(chain_of({"a", "b", "c"}, {true, true, true}), arm_to_match), InputError);
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

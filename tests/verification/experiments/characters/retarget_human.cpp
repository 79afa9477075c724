// Reference: the source's own limb directions (independent kinematics, bvh_kinematics.hpp), rigid bones, and what a
// body can do in 10 ms. Needs Debian's assimp-testmodels, which set-up installs.
#include "experiments/characters/named_bodies.hpp"
#include "experiments/clips/clip.hpp"

#include "tests/support/rounding_error.hpp"
#include "tests/verification/experiments/characters/bvh_kinematics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace {

using namespace pbs;

constexpr double degrees = 180.0 / M_PI;

// The clip 01_01 at its own 120 Hz: step i is the clip's frame i + 1.
struct Retargeted {
    std::string path = find_clip("01_01.bvh", ".");
    Clip clip = read_clip(path);
    Skeleton skeleton = human_skeleton();
    Motion motion;

    Retargeted()
    {
        ClipSampling sampling;
        sampling.time_step_s = clip.frame_time_s;
        sampling.rate_hz = 1.0 / clip.frame_time_s;
        motion = retarget(clip, skeleton, sampling);
    }
};

const Retargeted& cmu()
{
    static const Retargeted retargeted;
    return retargeted;
}

Vec3 posed_direction(const Pose& pose, const std::string& bone)
{
    const int index = find_bone(cmu().skeleton, bone);
    const Bone& rest = cmu().skeleton.bones[index];
    return pose[index].linear() * (rest.tail - rest.head).normalized();
}

struct Limb {
    std::string bone, from, to;  // our bone, and the source's joints at its ends
};

std::vector<Limb> limbs()
{
    std::vector<Limb> all;
    for (const auto& [side, prefix] : {std::pair<std::string, std::string>{".L", "Left"}, {".R", "Right"}}) {
        all.push_back({"upper_arm" + side, prefix + "Arm", prefix + "ForeArm"});
        all.push_back({"forearm_upper" + side, prefix + "ForeArm", prefix + "Hand"});
        all.push_back({"forearm_lower" + side, prefix + "ForeArm", prefix + "Hand"});
        all.push_back({"thigh" + side, prefix + "UpLeg", prefix + "Leg"});
        all.push_back({"shin" + side, prefix + "Leg", prefix + "Foot"});
        all.push_back({"foot" + side, prefix + "Foot", prefix + "ToeBase"});
    }
    return all;
}

TEST(RetargetHuman, EveryFrameIsThere)
{
    EXPECT_EQ(cmu().motion.steps.size(), 2751u);
    EXPECT_EQ(cmu().motion.frames(), 2751);
}

TEST(RetargetHuman, LimbsPointWhereTheSourcesDo)
{
    const bvh_kinematics::Bvh source = bvh_kinematics::read(cmu().path);
    const auto joint = [&](const std::string& name) {
        return std::find_if(source.joints.begin(), source.joints.end(), [&](const auto& j) { return j.name == name; }) -
               source.joints.begin();
    };
    double largest = 0.0;
    for (std::size_t step = 0; step < cmu().motion.steps.size(); step += 25) {
        const std::vector<Eigen::Isometry3d> joints = bvh_kinematics::forward(source, source.frames[step + 1]);
        for (const Limb& limb : limbs()) {
            const Vec3 expected = joints[joint(limb.to)].translation() - joints[joint(limb.from)].translation();
            const Vec3 direction = posed_direction(cmu().motion.steps[step], limb.bone);
            largest =
                std::max(largest, std::atan2(direction.cross(expected).norm(), direction.dot(expected)) * degrees);
        }
    }
    RecordProperty("largest_limb_angle_deg", std::to_string(largest));
    // The rotations are in single precision, over a chain of at most 9 joints with three products of rotations each.
    EXPECT_LT(largest, degrees * std::sqrt(3.0) * test_support::rounding_error_in<float>(2 * 3 * 9, 1.0));
}

TEST(RetargetHuman, TheTrunkTurnsAsTheSourceDoes)
{
    const bvh_kinematics::Bvh source = bvh_kinematics::read(cmu().path);
    for (const auto& [bone, name] :
         {std::pair<std::string, std::string>{"pelvis", "Hips"}, {"chest", "Spine1"}, {"head", "Head"}}) {
        const int index = find_bone(cmu().skeleton, bone);
        const std::string& wanted = name;
        const auto joint =
            std::find_if(source.joints.begin(), source.joints.end(), [&](const auto& j) { return j.name == wanted; });
        for (std::size_t step = 0; step < cmu().motion.steps.size(); step += 100) {
            const auto joints = bvh_kinematics::forward(source, source.frames[step + 1]);
            const Eigen::Matrix3d turned = cmu().motion.steps[step][index].linear(),
                                  expected = joints[joint - source.joints.begin()].linear();
            // In single precision, over a chain of at most 9 joints with three products of rotations each, for nine
            // entries.
            EXPECT_LT((turned - expected).norm(), 3.0 * test_support::rounding_error_in<float>(2 * 3 * 9, 1.0)) << bone;
        }
    }
}

TEST(RetargetHuman, BonesAreRigidAndStayJoined)
{
    const Skeleton& skeleton = cmu().skeleton;
    double largest_gap_m = 0.0, largest_shear = 0.0;
    for (const Pose& pose : cmu().motion.steps)
        for (std::size_t b = 0; b < pose.size(); ++b) {
            const Eigen::Matrix3d rotation = pose[b].linear();
            largest_shear = std::max(
                largest_shear, (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff());
            EXPECT_GT(rotation.determinant(), 0.0);
            if (const int parent = skeleton.bones[b].parent; parent >= 0)
                largest_gap_m = std::max(
                    largest_gap_m, (pose[b] * skeleton.bones[b].head - pose[parent] * skeleton.bones[b].head).norm());
        }
    EXPECT_LT(largest_shear, 2.0 * test_support::motion_matrix_error(1, 0.0));  // of a unit quaternion, twice
    // of two bones and the joint, within 4 m
    EXPECT_LT(largest_gap_m, test_support::motion_error(2 + 1, 4.0));
}

TEST(RetargetHuman, NothingFlips)
{
    ClipSampling sampling;  // 100 Hz
    const Motion motion = retarget(cmu().clip, cmu().skeleton, sampling);
    double largest_deg = 0.0, largest_move_m = 0.0;
    for (std::size_t step = 1; step < motion.steps.size(); ++step) {
        for (std::size_t b = 0; b < motion.steps[step].size(); ++b) {
            const Eigen::Quaterniond before(motion.steps[step - 1][b].linear()), after(motion.steps[step][b].linear());
            largest_deg = std::max(largest_deg, before.angularDistance(after) * degrees);
        }
        const Vec3 hip = cmu().skeleton.bones[0].head;
        largest_move_m =
            std::max(largest_move_m, (motion.steps[step][0] * hip - motion.steps[step - 1][0] * hip).norm());
    }
    RecordProperty("largest_angle_per_10_ms_deg", std::to_string(largest_deg));
    RecordProperty("largest_root_move_per_10_ms_m", std::to_string(largest_move_m));
    // Fast human joints turn at some 30 rad/s, 17 degrees in 10 ms, and hips in a jump move at some 4 m/s; a flip would
    // be 180 degrees.
    EXPECT_LT(largest_deg, 25.0);
    EXPECT_LT(largest_move_m, 0.05);
}

TEST(RetargetHuman, BeginsAtItsRestPlaceAndJumpsAsHighAsALegAllows)
{
    const Vec3 hip = cmu().skeleton.bones[0].head;
    const Bone& shin = cmu().skeleton.bones[find_bone(cmu().skeleton, "shin.L")];
    EXPECT_LT((cmu().motion.steps.front()[0] * hip - hip).norm(), test_support::motion_error(2, 4.0));
    double highest_m = 0.0;
    for (const Pose& pose : cmu().motion.steps) highest_m = std::max(highest_m, (pose[0] * hip - hip)(1));
    RecordProperty("highest_hip_above_start_m", std::to_string(highest_m));
    EXPECT_GT(highest_m, 0.1);                                   // it does jump
    EXPECT_LT(highest_m, 2.0 * (shin.head - shin.tail).norm());  // no unit is confused
}

TEST(RetargetHuman, TheForearmSharesTheWristsTwistInThirds)
{
    double largest_twist_deg = 0.0;
    for (const Pose& pose : cmu().motion.steps)
        for (const std::string side : {".L", ".R"}) {
            const auto rotation = [&](const std::string& bone) {
                return Eigen::Quaterniond(pose[find_bone(cmu().skeleton, bone + side)].linear());
            };
            // Both halves lie in one line at rest, so their relative rotation is exactly a third of the twist about
            // that line.
            const Eigen::AngleAxisd between(rotation("forearm_lower") * rotation("forearm_upper").conjugate());
            if (between.angle() * degrees < 0.5) continue;
            largest_twist_deg = std::max(largest_twist_deg, 3.0 * between.angle() * degrees);
            EXPECT_GT(std::abs(between.axis().dot(posed_direction(pose, "forearm_upper" + side))), 0.999);
        }
    RecordProperty("largest_wrist_twist_deg", std::to_string(largest_twist_deg));
    EXPECT_GT(largest_twist_deg, 10.0);   // there is a twist
    EXPECT_LT(largest_twist_deg, 150.0);  // and no wrist turns farther
}

}  // namespace

// Reference: rigid kinematics. A joint is connected if parent and child move it to the same place; slerp rotates at a
// constant rate. Tolerances: the rounding of motions. A path takes three per joint: that of the pose, its inverse
// relative to the parent, and slerp.

#include "pbs/skinning/pose.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace pose_path_tests {
namespace {

using pbs::PosePath;
using pbs::Vec3;

const pbs::Skeleton arm{
    {{"upper", -1, {0, 0, 0}, {1, 0, 0}}, {"fore", 0, {1, 0, 0}, {2, 0, 0}}, {"hand", 1, {2, 0, 0}, {2.5, 0, 0}}}};

Eigen::Quaterniond turn(double angle_deg, const Vec3& axis)
{
    return Eigen::Quaterniond(Eigen::AngleAxisd(angle_deg * std::acos(-1.0) / 180.0, axis.normalized()));
}

pbs::Pose pose(const Eigen::Quaterniond& upper, const Eigen::Quaterniond& fore, const Eigen::Quaterniond& hand,
               const Vec3& root)
{
    return pbs::pose_from_joints(arm, {upper, fore, hand}, root);
}

const Eigen::Quaterniond still = Eigen::Quaterniond::Identity();
const pbs::Pose at_rest = pose(still, still, still, Vec3::Zero());
const pbs::Pose crouched = pose(turn(40, {1, 2, 0}), turn(100, {0, 1, 3}), turn(-70, {1, 1, 1}), {0.3, -2, 1});
const pbs::Pose stretched = pose(turn(-20, {0, 1, 0}), turn(5, {1, 0, 0}), turn(60, {0, 0, 1}), {1, 1, 1});

void expect_near(const pbs::Pose& a, const pbs::Pose& b)
{
    // of three joints on a path, and of three others
    const double rounding = test_support::motion_matrix_error(3 * 3 + 3, 2.0);
    for (std::size_t j = 0; j < a.size(); ++j)
        EXPECT_LT((a[j].matrix() - b[j].matrix()).norm(), rounding) << arm.bones[j].name;
}

TEST(PosePath, ItsEndsAreThePosesToTheBit)
{
    const PosePath path(arm, crouched, stretched);
    for (std::size_t j = 0; j < arm.bones.size(); ++j) {
        EXPECT_EQ(path.at(0.0)[j].matrix(), crouched[j].matrix());
        EXPECT_EQ(path.at(1.0)[j].matrix(), stretched[j].matrix());
    }
}

TEST(PosePath, JointsStayJoinedAndBonesRigid)
{
    const PosePath path(arm, crouched, stretched);
    for (const double fraction : {0.1, 0.5, 0.77}) {
        const pbs::Pose between = path.at(fraction);
        for (std::size_t j = 1; j < arm.bones.size(); ++j) {
            const Vec3 joint = arm.bones[j].head;
            EXPECT_LT((between[j] * joint - between[arm.bones[j].parent] * joint).norm(),
                      test_support::motion_error(3 * 3 + 3 * 2, 5.0));
        }
        for (const auto& bone : between)
            EXPECT_LT((bone.linear() * bone.linear().transpose() - Eigen::Matrix3d::Identity()).norm(),
                      test_support::motion_matrix_error(2 * 3 * 3, 0.0));
    }
}

TEST(PosePath, TurnsAtAnEvenRateAndTheShortWayRound)
{
    expect_near(PosePath(arm, at_rest, pose(still, turn(80, Vec3::UnitZ()), still, Vec3::Zero())).at(0.25),
                pose(still, turn(20, Vec3::UnitZ()), still, Vec3::Zero()));
    expect_near(PosePath(arm, at_rest, pose(still, turn(270, Vec3::UnitZ()), still, Vec3::Zero())).at(0.5),
                pose(still, turn(-45, Vec3::UnitZ()), still, Vec3::Zero()));
}

TEST(PosePath, TheRootMovesInAStraightLine)
{
    const PosePath path(arm, pose(still, still, still, {1, 0, 0}),
                        pose(turn(90, Vec3::UnitY()), still, still, {3, 4, 0}));
    EXPECT_LT((path.at(0.5)[0] * arm.bones[0].head - Vec3(2, 2, 0)).norm(), test_support::motion_error(3, 5.0));
}

// A clip may shift a bone relative to its parent: the head then moves at a constant rate in the parent's frame.
TEST(PosePath, AHeadThatLeavesItsParentMovesEvenly)
{
    pbs::Pose pulled(3, Eigen::Isometry3d::Identity());
    pulled[1].translation() = pulled[2].translation() = Vec3(0.4, 0, 0);
    const pbs::Pose half = PosePath(arm, pbs::Pose(3, Eigen::Isometry3d::Identity()), pulled).at(0.5);
    EXPECT_LT((half[1] * arm.bones[1].head - Vec3(1.2, 0, 0)).norm(), test_support::motion_error(2 * 3, 1.4));
    EXPECT_LT((half[2] * arm.bones[2].head - Vec3(2.2, 0, 0)).norm(), test_support::motion_error(3 * 3, 2.4));
}

TEST(PosePath, TheLargestTurnIsThatOfABoneInTheWorld)
{
    const pbs::Pose bent = pose(still, turn(30, Vec3::UnitZ()), turn(25, Vec3::UnitZ()), Vec3::Zero());
    const double rounding = test_support::motion_matrix_error(3 + 1, 0.0);  // three joints, and the angle of a matrix
    EXPECT_NEAR(PosePath(arm, at_rest, bent).largest_turn_deg(), 55.0, rounding * 180.0 / std::acos(-1.0));
    EXPECT_EQ(PosePath(arm, bent, bent).largest_turn_deg(), 0.0);
}

// Reference: a rigid motion and its inverse. Tolerances: the rounding of two motions, one of them on each side or both
// on one.

using pbs::RootFrame;
using test_support::motion_error;

const pbs::Skeleton two_bones{{{"root", -1, {0, 0, 0}, {1, 0, 0}}, {"child", 0, {1, 0, 0}, {2, 0, 0}}}};
const Eigen::Isometry3d motion = Eigen::Translation3d(3, -1, 2) * Eigen::AngleAxisd(2.0, Vec3(1, 2, -3).normalized());

TEST(RootFrame, RemovesTheRootsMotionAndPutsItBack)
{
    const Eigen::Isometry3d bend(Eigen::AngleAxisd(0.5, Vec3::UnitZ()));
    const RootFrame frame(two_bones, {motion, motion * bend});
    const double rounding = test_support::motion_matrix_error(2, motion.translation().norm());
    EXPECT_LT((frame.pose()[0].matrix() - Eigen::Matrix4d::Identity()).norm(), rounding);
    EXPECT_LT((frame.pose()[1].matrix() - bend.matrix()).norm(), rounding);
    const Vec3 point(0.1, 0.2, 0.3);
    const pbs::Positions one = point.transpose();
    const double farthest = motion.translation().norm() + point.norm();
    EXPECT_LT((frame.to_world(one).row(0).transpose() - motion * point).norm(), motion_error(2, farthest));
    EXPECT_LT((frame.to_root(frame.to_world(one)) - one).norm(), motion_error(2, farthest));
}

TEST(RootFrame, TurnsDirectionsIntoItself)
{
    const RootFrame frame(two_bones, {motion, motion});
    const Vec3 gravity(0, -9.81, 1);
    EXPECT_LT((motion.linear() * frame.from_world(gravity) - gravity).norm(), motion_error(2, gravity.norm()));
}

// Reference: the definition. A frame lasts 1 / rate, and n steps fill it.

using namespace pbs;
using test_support::refusal_of;

TEST(TimeStepFor, FillsAFrameWithWholeStepsOfAtMostAHundredthOfASecond)
{
    const std::pair<double, int> steps_at[] = {{24.0, 5}, {25.0, 4},  {30.0, 4},  {50.0, 2},
                                               {60.0, 2}, {100.0, 1}, {120.0, 1}, {1.0, 100}};
    for (const auto& [rate_hz, steps] : steps_at) {
        const double time_step_s = time_step_for(rate_hz);
        EXPECT_DOUBLE_EQ(time_step_s, 1.0 / (rate_hz * steps)) << rate_hz;
        EXPECT_LE(time_step_s, 0.01 * (1.0 + 1e-6)) << rate_hz;
        EXPECT_EQ(steps_per_frame({.rate_hz = rate_hz, .time_step_s = time_step_s}), steps) << rate_hz;
    }
}

TEST(TimeStepFor, IsTheLongestSuchStep)
{
    for (const double longest_s : {0.001, 0.003, 0.01, 0.02, 1.0}) {
        for (double rate_hz = 1.0; rate_hz < 150.0; rate_hz += 0.37) {
            const double time_step_s = time_step_for(rate_hz, longest_s);
            const double steps = 1.0 / (rate_hz * time_step_s);
            EXPECT_NEAR(steps, std::round(steps), 1e-9 * steps);
            EXPECT_LE(time_step_s, longest_s * (1.0 + 1e-6));
            if (std::round(steps) > 1.0) {
                EXPECT_GT(1.0 / (rate_hz * (std::round(steps) - 1.0)), longest_s);
            }
        }
    }
}

TEST(StepsPerFrame, AcceptTimesWrittenWithSixDigits)
{
    EXPECT_EQ(steps_per_frame({.rate_hz = 30.0, .time_step_s = 0.00833333333}), 4);
    EXPECT_EQ(steps_per_frame({.rate_hz = 1.0, .time_step_s = 1e-5}), 100000);
}

TEST(StepsPerFrame, ThatAreNotWholeOrTooManyOrOfNoTimeAreRefused)
{
    const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
    struct Case {
        MotionSampling sampling;
        std::string message;  // a part of it
    };
    for (const auto& [sampling, message] :
         {Case{{.rate_hz = 30.0, .time_step_s = 0.01}, "expected 1 / n"},
          Case{{.rate_hz = 30.0, .time_step_s = 0.1}, "expected 1 / n"},
          Case{{.rate_hz = 1.0, .time_step_s = 1e-6}, "100000 steps"}, Case{{.rate_hz = 0.0}, "rate_hz = "},
          Case{{.rate_hz = -1.0}, "rate_hz = "}, Case{{.rate_hz = nan}, "rate_hz = "},
          Case{{.rate_hz = infinite}, "rate_hz"}, Case{{.time_step_s = 0.0}, "time_step_s = "},
          Case{{.time_step_s = -1.0}, "time_step_s = "}, Case{{.time_step_s = nan}, "time_step_s = "}}) {
        const std::string refusal = refusal_of([&] { steps_per_frame(sampling); });
        EXPECT_NE(refusal.find(message), std::string::npos) << refusal;
    }
}

TEST(FramesAfterTheFirst, FillTheStretch)
{
    EXPECT_EQ(frames_after_the_first({.rate_hz = 25.0}, 2.0, 0.0, "a.bvh"), 50);
    EXPECT_EQ(frames_after_the_first({.start_s = 0.5, .rate_hz = 25.0}, 2.0, 0.0, "a.bvh"), 37);
    EXPECT_EQ(frames_after_the_first({.start_s = 0.5, .duration_s = 1.0, .rate_hz = 25.0}, 2.0, 0.0, "a.bvh"), 25);
    EXPECT_EQ(frames_after_the_first({.rate_hz = 25.0}, 0.0, 0.0, "a.bvh"), 0) << "a single key";
    EXPECT_EQ(frames_after_the_first({.rate_hz = 10.0}, 0.3, 0.0, "a.bvh"), 3) << "0.3 * 10 is rounded below 3";
}

TEST(FramesAfterTheFirst, OfAStretchBeyondTheRecordingAreRefusedByFile)
{
    const auto refused = [](const MotionSampling& sampling) {
        return refusal_of([&] { frames_after_the_first(sampling, 2.0, 1e-6, "a.bvh"); });
    };
    EXPECT_EQ(refused({.start_s = 2.1}), "a.bvh: start_s = 2.100000: the clip lasts 2.000000 s");
    EXPECT_EQ(refused({.start_s = -0.1}).rfind("a.bvh: start_s = -0.1", 0), 0u);
    EXPECT_EQ(refused({.start_s = 1.5, .duration_s = 0.6}).rfind("a.bvh: duration_s = 0.6", 0), 0u);
    EXPECT_EQ(refused({.duration_s = -1.0}).rfind("a.bvh: duration_s = -1", 0), 0u);
    EXPECT_EQ(refused({.start_s = std::numeric_limits<double>::quiet_NaN()}).rfind("a.bvh: start_s = nan", 0), 0u);
    EXPECT_EQ(refused({.start_s = 1.0, .duration_s = 1.0 + 5e-7}), "accepted") << "within the slack";
}

}  // namespace
}  // namespace pose_path_tests

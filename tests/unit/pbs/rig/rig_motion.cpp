// Reference: an elbow that turns half round within 1 s at a constant rate. Angles are in error by some hundred roundings.
#include "pbs/rig/rig_motion.hpp"

#include "tests/support/rounding_error.hpp"
#include "tests/support/two_joint_rig.hpp"
#include "tests/unit/pbs/character/expect_input_error.hpp"

#include <gtest/gtest.h>

namespace {

using namespace pbs;

const double motion_rounding = test_support::rounding_error(512, 8.0);

class RigMotionOfAnElbow : public testing::Test {
protected:
    RigMotion motion(const MotionSampling& sampling) const { return rig_motion(rig, body, rig.animations[0], sampling); }

    Rig rig = test_support::two_joint_rig();
    RiggedBody body = make_rigged_body(rig, nullptr, 1.0);
};

TEST_F(RigMotionOfAnElbow, HasAPosePerTimeStepFromTheFirstKeyToTheLast)
{
    const Motion made = motion({.rate_hz = 4.0, .time_step_s = 0.125}).motion;
    EXPECT_EQ(made.steps_per_frame, 2);
    EXPECT_EQ(made.frames(), 5);
    ASSERT_EQ(made.steps.size(), 9u);
    for (std::size_t step = 0; step < made.steps.size(); ++step) {
        const Eigen::Matrix3d expected(Eigen::AngleAxisd(M_PI * double(step) / 8.0, Vec3::UnitZ()));
        EXPECT_LE((made.steps[step][1].linear() - expected).cwiseAbs().maxCoeff(), motion_rounding) << step;
        EXPECT_LE((made.steps[step][0].matrix() - Eigen::Matrix4d::Identity()).cwiseAbs().maxCoeff(), motion_rounding) << step;
    }
}

TEST_F(RigMotionOfAnElbow, BeginsAfterTheFirstKeyWhereverThatIs)
{
    rig.animations[0].nodes[0].rotation->times_s = {10.0, 11.0};
    rig.animations[0].start_s = 10.0;
    rig.animations[0].end_s = 11.0;
    const Motion made = motion({.start_s = 0.5, .rate_hz = 4.0, .time_step_s = 0.25}).motion;
    EXPECT_EQ(made.frames(), 3);
    EXPECT_LE((made.steps[0][1] * Vec3(1, 4, 0) - Vec3(-1, 2, 0)).norm(), motion_rounding);
}

TEST_F(RigMotionOfAnElbow, ReportsTheStretchThatIsLeftOut)
{
    EXPECT_NEAR(motion({.rate_hz = 4.0, .time_step_s = 0.25}).stretch, 0.0, motion_rounding);
    KeyTrack grow;
    grow.times_s = {0.0, 1.0};
    grow.values = {{1, 1, 1, 0}, {1, 1.25, 1, 0}};
    rig.animations[0].nodes[0].scale = grow;
    EXPECT_NEAR(motion({.rate_hz = 4.0, .time_step_s = 0.25}).stretch, 0.25, motion_rounding);
}

TEST_F(RigMotionOfAnElbow, TheArtistsFramesAreThoseOfTheMotion)
{
    const MotionSampling sampling{.start_s = 0.5, .rate_hz = 4.0, .time_step_s = 0.125};
    const Positions frame = artist_frame(rig, body, rig.animations[0], sampling, 2);  // 1 s after the first key
    Positions expected(4, 3);
    expected << 1, 0, 0, 1, 2, 0, 1, 0, 0, 0.5, 2, 0;
    EXPECT_LE((frame - expected).cwiseAbs().maxCoeff(), motion_rounding);
}

TEST_F(RigMotionOfAnElbow, AStretchBeyondTheAnimationIsRefused)
{
    expect_input_error([&] { motion({.start_s = 1.5, .rate_hz = 4.0, .time_step_s = 0.25}); }, "arm.gltf: start_s = 1.5", "lasts 1.0");
    expect_input_error([&] { motion({.start_s = 0.5, .duration_s = 0.75, .rate_hz = 4.0, .time_step_s = 0.25}); },
                       "arm.gltf: duration_s = 0.75", "ends at 1.0");
}

TEST_F(RigMotionOfAnElbow, AnAnimationOfASingleKeyHasOneFrame)
{
    rig.animations[0].nodes[0].rotation->times_s = {0.0};
    rig.animations[0].nodes[0].rotation->values.resize(1);
    rig.animations[0].end_s = 0.0;
    EXPECT_EQ(motion({.rate_hz = 4.0, .time_step_s = 0.25}).motion.frames(), 1);
}

}  // namespace

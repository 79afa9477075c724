// Reference: the definition. A frame lasts 1 / rate, and n steps fill it.
#include "pbs/skinning/pose_path.hpp"

#include "pbs/geometry/input_error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace {

using namespace pbs;

std::string refusal_of(const std::function<void()>& run)
{
    try {
        run();
    } catch (const InputError& error) {
        return error.what();
    }
    return "nothing was refused";
}

TEST(TimeStepFor, FillsAFrameWithWholeStepsOfAtMostAHundredthOfASecond)
{
    const std::pair<double, int> steps_at[] = {{24.0, 5}, {25.0, 4}, {30.0, 4}, {50.0, 2}, {60.0, 2}, {100.0, 1}, {120.0, 1}, {1.0, 100}};
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

TEST(StepsPerFrame, ThatAreNotWholeOrTooManyAreRefused)
{
    EXPECT_NE(refusal_of([] { steps_per_frame({.rate_hz = 30.0, .time_step_s = 0.01}); }).find("expected 1 / n"), std::string::npos);
    EXPECT_NE(refusal_of([] { steps_per_frame({.rate_hz = 30.0, .time_step_s = 0.1}); }).find("expected 1 / n"), std::string::npos);
    EXPECT_NE(refusal_of([] { steps_per_frame({.rate_hz = 1.0, .time_step_s = 1e-6}); }).find("100000 steps"), std::string::npos);
}

TEST(StepsPerFrame, OfARateOrATimeStepThatIsNotPositiveAreRefusedByName)
{
    for (const double bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
        EXPECT_EQ(refusal_of([&] { steps_per_frame({.rate_hz = bad}); }).rfind("rate_hz = ", 0), 0u) << bad;
        EXPECT_EQ(refusal_of([&] { steps_per_frame({.time_step_s = bad}); }).rfind("time_step_s = ", 0), 0u) << bad;
    }
    EXPECT_NE(refusal_of([] { steps_per_frame({.rate_hz = std::numeric_limits<double>::infinity()}); }), "nothing was refused");
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
    EXPECT_EQ(refused({.start_s = 1.0, .duration_s = 1.0 + 5e-7}), "nothing was refused") << "within the slack";
}

}  // namespace

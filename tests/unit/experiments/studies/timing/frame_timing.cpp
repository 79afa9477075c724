// Expected: a whole takes longer than its parts, and every variant has the same number of rounds. The times themselves are not compared,
// since others use the machine too.
#include "experiments/studies/timing/frame_timing.hpp"

#include "pbs/skinning/pose.hpp"
#include "tests/support/limb_character.hpp"

#include <gtest/gtest.h>

namespace {

using namespace experiments;

TEST(FrameTiming, OfEveryVariantByTurns)
{
    const pbs::Character limb = test_support::character_of(test_support::two_bone_limb({20, 6, 6}, pbs::Vec3::UnitZ(), 0.0));
    const pbs::Motion motion = pbs::joint_sweep(limb.skeleton, 1, pbs::Vec3::UnitZ(), 60.0, 4, 0.01);  // fewer frames than the turns need
    const auto timings = time_frames(limb, motion, {.k_jiggle = 0.5, .frames_per_turn = 3}, {.seconds = 0.0, .fewest = 5, .most = 5});
    ASSERT_EQ(timings.size(), 3u);
    EXPECT_EQ(timings[0].variant + timings[0].precision, "plainf64");
    EXPECT_EQ(timings[1].variant + timings[1].precision, "plainf32");
    EXPECT_EQ(timings[2].variant + timings[2].precision, "orderedf32");
    for (const FrameTiming& timing : timings) {
        EXPECT_EQ(timing.total_ms.rounds, 5);
        EXPECT_GT(timing.lbs_ms.median, 0.0);
        EXPECT_GT(timing.bind_ms.median, 0.0);
        EXPECT_GT(timing.stretch_ms.median, timing.bind_ms.median);  // seven times as many constraints
        EXPECT_GT(timing.total_ms.median, timing.lbs_ms.median);
        EXPECT_GT(timing.rest_ms.lower, 0.0);
        EXPECT_GT(timing.total_ms.median, timing.rest_ms.median);  // which has no iterations
        EXPECT_GT(timing.total_wall_ms.median, 0.0);
        EXPECT_FALSE(timing.surface_ms);  // the limb has none
        EXPECT_FALSE(timing.drawn_wall_ms);
    }
}

}  // namespace

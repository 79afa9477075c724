// The time of Newton's method to the goal. Reference: its definition in newton_way.hpp, by hand.
#include "experiments/studies/work_precision/newton_way.hpp"

#include "experiments/scene/scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>

namespace {

using namespace experiments;

// The limit is replaced by LBS, so that Newton's method is there without a step.
TEST(NewtonWays, HaveTheTimeOfTheInitialGuessWhereItNeedsNoStep)
{
    WorkPrecisionCase of;
    of.scene = read_scene("limb_twist", {"character.vertices=300", "motion.angle_deg=30", "motion.frames=7"});
    of.range.in_short = true;
    const BodyMesh mesh(std::make_shared<pbs::Character>(pbs::make_character(of.scene.character)));
    const pbs::Motion motion = make_motion(of.scene.motion, mesh.character().skeleton, of.scene.file);
    const PosePair poses{motion.steps.back(), motion.steps.front(), motion.time_step_s};
    const PosedReference reference(mesh.character(), reference_flesh(of.scene), poses.pose, poses.time_step_s, false);
    const std::vector<PointSetting> settings = point_settings(of.scene, of.range);
    const auto flesh = std::ranges::find_if(settings, [](const PointSetting& one) { return one.is_limit_of_deformers(); });
    ASSERT_NE(flesh, settings.end());
    const std::vector<NewtonRow> rows = newton_way(of, *flesh, mesh, poses, blended(mesh.character(), poses.pose), reference);
    const auto lbs = std::ranges::find(rows, NewtonStart::lbs, &NewtonRow::start);
    ASSERT_NE(lbs, rows.end());
    EXPECT_EQ(std::tuple(lbs->newton_steps, lbs->timed_steps, lbs->to_limit_pct), std::tuple(0, std::optional(0), 0.0));
    EXPECT_GT(lbs->guess_ms.value_or(0.0), 0.0);
    EXPECT_EQ(lbs->ms_median, lbs->guess_ms);
}

TEST(NewtonWays, TakeNoTimeOfZeroForTheFastest)
{
    const NewtonRow no_time = {.start = NewtonStart::lbs, .ms_median = 0.0, .to_limit_pct = 0.5};
    const NewtonRow timed = {.start = NewtonStart::rest, .newton_steps = 9, .ms_median = 80.0, .to_limit_pct = 0.0};
    EXPECT_FALSE(fastest_to_goal({no_time}));
    EXPECT_EQ(fastest_to_goal({no_time, timed}).value().start, NewtonStart::rest);
}

// A whole solve needs 2 more steps than single steps, then 6 more, of which 5 are tried. A broken solve is not a number away.
TEST(NewtonWays, StateTheStepsThatAreTimed)
{
    const auto within_after = [](int needed) { return [needed](int steps) { return steps < needed ? 1.1 : newton_goal_pct; }; };
    EXPECT_EQ(steps_to_goal(4, within_after(4)), std::optional(4));
    EXPECT_EQ(steps_to_goal(4, within_after(6)), std::optional(6));
    EXPECT_EQ(steps_to_goal(4, within_after(9)), std::optional(9));
    EXPECT_FALSE(steps_to_goal(4, within_after(10)));
    EXPECT_FALSE(steps_to_goal(4, [](int) { return std::numeric_limits<double>::quiet_NaN(); }));
}

}  // namespace

// Reference: curves of error over time whose values at a budget and choices are computed by hand; means and intervals of a few poses by
// hand.
#include "experiments/studies/work_precision/gains.hpp"

#include "experiments/studies/work_precision/compared_deformers.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

using namespace experiments;
using analysis::CaseKey;

const CaseKey limb_twist_pose = {.body = "limb", .motion = "twist", .angle_deg = 90.0},
              limb_bend_pose = {.body = "limb", .motion = "bend", .angle_deg = 60.0},
              human_crouch_pose = {.body = "human", .motion = "01_01", .pose = "crouch"},
              human_standing_pose = {.body = "human", .motion = "01_01", .pose = "standing"};

PointRow change_point(const CaseKey& of, const std::string& change, const std::string& setting, int iterations, double ms, double error_pct,
                      std::optional<double> bound_pct = 0.01, double distance_pct = 1.0)
{
    PointRow point{.of = of, .key = {.deformer = change, .iterations = iterations, .tuned = setting}, .ms_median = ms};
    if (std::isfinite(error_pct)) point.error = {.joint_pct = error_pct};
    point.metrics.emplace();
    point.from_pbs_pct.fill(distance_pct);
    point.reference_error_joint_pct = bound_pct;
    return point;
}

// The baseline takes 1, 6 and 24 ms for 4, 24 and 96 iterations and has an error of 10 % throughout.
std::vector<PointRow> baseline_in(const std::vector<CaseKey>& poses)
{
    std::vector<PointRow> points;
    for (const CaseKey& of : poses)
        for (const int iterations : budget_iterations) points.push_back(change_point(of, baseline, "", iterations, iterations / 4.0, 10.0));
    return points;
}

const EqualTimeRow* row_of(const std::vector<EqualTimeRow>& rows, int budget, const std::string& change, const CaseKey& of)
{
    const auto found = std::ranges::find_if(rows, [&](const EqualTimeRow& row) {
        return row.group == all_poses && row.budget_iterations == budget && row.change == change && row.of == of;
    });
    return found == rows.end() ? nullptr : &*found;
}

TEST(EqualTime, InterpolatesInTheLogarithmOfTime)
{
    std::vector<PointRow> points = baseline_in({limb_twist_pose});
    points.push_back(change_point(limb_twist_pose, "slower", "", 1, 3.0, 9.0));
    points.push_back(change_point(limb_twist_pose, "slower", "", 5, 12.0, 5.0));  // 6 ms are halfway between 3 and 12
    const std::vector<EqualTimeRow> rows = at_equal_time(points);
    const double rounding = test_support::rounding_error(10, 10.0);
    EXPECT_EQ(row_of(rows, 4, "slower", limb_twist_pose), nullptr) << "its first point takes longer than 1 ms";
    const EqualTimeRow *halfway = row_of(rows, 24, "slower", limb_twist_pose), *last = row_of(rows, 96, "slower", limb_twist_pose);
    ASSERT_TRUE(halfway && last);
    EXPECT_NEAR(halfway->error_pct, 7.0, rounding);
    EXPECT_NEAR(halfway->iterations, 3.0, rounding);
    EXPECT_NEAR(halfway->gain_pct(), 3.0, rounding);
    EXPECT_EQ(last->error_pct, 5.0) << "after the last point the error stays";
    EXPECT_EQ(last->iterations, 5.0);
}

TEST(EqualTime, ChoosesASettingOnTheOtherPoses)
{
    const std::vector<CaseKey> poses = {limb_twist_pose, limb_bend_pose, human_crouch_pose};
    std::vector<PointRow> points = baseline_in(poses);
    for (const CaseKey& of : poses) {
        points.push_back(change_point(of, "change", "b", 1, 0.5, of == limb_twist_pose ? 1.0 : 8.0));
        points.push_back(change_point(of, "change", "c", 1, 0.5, of == limb_twist_pose ? 9.0 : 4.0));
    }
    points.push_back(change_point(limb_twist_pose, "change", "a_only_here", 1, 0.5, 0.1));
    const std::vector<EqualTimeRow> rows = at_equal_time(points);
    EXPECT_EQ(row_of(rows, 24, "change", limb_twist_pose)->setting, "c") << "b is best in this pose and worst in the others";
    EXPECT_EQ(row_of(rows, 24, "change", limb_twist_pose)->error_pct, 9.0);
    EXPECT_EQ(row_of(rows, 24, "change", limb_bend_pose)->setting, "b");
    EXPECT_EQ(row_of(rows, 24, "change", human_crouch_pose)->setting, "b");
}

TEST(EqualTime, EachBodyChoosesOnItsOwnPosesToo)
{
    const std::vector<CaseKey> poses = {limb_twist_pose, limb_bend_pose, human_crouch_pose, human_standing_pose};
    std::vector<PointRow> points = baseline_in(poses);
    for (const CaseKey& of : poses) {
        points.push_back(change_point(of, "change", "of_the_limb", 1, 0.5, of.body == "limb" ? 1.0 : 8.0));
        points.push_back(change_point(of, "change", "of_the_human", 1, 0.5, of.body == "limb" ? 9.0 : 1.0));
    }
    for (const EqualTimeRow& row : at_equal_time(points))
        if (row.group != all_poses) {
            EXPECT_EQ(row.group, row.of.body);
            EXPECT_EQ(row.setting, "of_the_" + row.group);
        }
}

// A setting without a time, for example one whose frames are not finite, takes longer than any budget.
TEST(EqualTime, APoseWithoutAnErrorOrATimeHasNoValue)
{
    std::vector<PointRow> points = baseline_in({limb_twist_pose});
    points.push_back(change_point(limb_twist_pose, "broken", "", 1, 0.5, std::nan("")));
    points.push_back(change_point(limb_twist_pose, "diverging", "", 1, 0.5, 8.0));
    points.push_back(change_point(limb_twist_pose, "diverging", "", 4, 1.0, std::nan("")));
    points.back().ms_median.reset();
    for (const char* change : {"broken", "diverging"})
        EXPECT_EQ(row_of(at_equal_time(points), 24, change, limb_twist_pose), nullptr) << change;
}

std::vector<PointRow> some_poses(const std::vector<double>& good, const std::vector<double>& better, double bound_pct)
{
    std::vector<CaseKey> poses = {limb_twist_pose, limb_bend_pose, human_crouch_pose, human_standing_pose};
    poses.resize(good.size());
    std::vector<PointRow> points = baseline_in(poses);
    for (std::size_t i = 0; i < good.size(); ++i) {
        points.push_back(change_point(poses[i], "good", "", 1, 0.5, good[i], bound_pct));
        points.push_back(change_point(poses[i], "better", "", 1, 0.5, better[i], bound_pct));
        points.push_back(change_point(poses[i], control, "k_bind_0.5", 1, 0.5, 0.5, bound_pct));
    }
    return points;
}

const GainRow& gain_of(const std::vector<GainRow>& gains, const std::string& change, const std::string& than)
{
    return *std::ranges::find_if(gains, [&](const GainRow& gain) {
        return gain.group == all_poses && gain.budget_iterations == 24 && gain.change == change && gain.than == than;
    });
}

TEST(Gains, AreMeansOverThePosesTheLargestFirst)
{
    const std::vector<GainRow> gains = gains_of(at_equal_time(some_poses({8.0, 7.0, 6.0, 7.0}, {4.0, 5.0, 3.0, 4.0}, 0.01)));
    const GainRow& better = gain_of(gains, "better", baseline);
    EXPECT_NEAR(better.gain_pct, 6.0, test_support::rounding_error(10, 10.0));
    EXPECT_EQ(better.poses, 4);
    EXPECT_LE(*better.gain_low_pct, 6.0);
    EXPECT_GE(*better.gain_low_pct, 5.0);
    EXPECT_EQ(better.decision, GainDecision::decided);
    const GainRow& versus = gain_of(gains, "better", "good");
    EXPECT_NEAR(versus.gain_pct, 3.0, test_support::rounding_error(10, 10.0));
    EXPECT_EQ(versus.decision, GainDecision::decided);
    EXPECT_EQ(std::ranges::count(gains, "good", &GainRow::than) > 0, true) << "the control has the least error, and is no change";
    EXPECT_LT(gain_of(gains, "better", control).gain_pct, 0.0);
}

TEST(Gains, AreUndecidedWithinTheReferencesOwnErrorWhereThePosesDisagreeOrAreFewerThanFour)
{
    const std::vector<GainRow> gains = gains_of(at_equal_time(some_poses({8.0, 7.0, 6.0, 7.0}, {4.0, 5.0, 3.0, 4.0}, 4.0)));
    EXPECT_EQ(gain_of(gains, "better", "good").decision, GainDecision::reference_error);
    std::vector<PointRow> unknown = some_poses({8.0, 7.0, 6.0, 7.0}, {4.0, 5.0, 3.0, 4.0}, 0.01);
    for (PointRow& point : unknown) point.reference_error_joint_pct.reset();
    EXPECT_EQ(gain_of(gains_of(at_equal_time(unknown)), "better", baseline).decision, GainDecision::reference_error);
    const std::vector<GainRow> contrary = gains_of(at_equal_time(some_poses({2.0, 18.0, 5.0, 11.0}, {4.0, 17.0, 6.0, 12.0}, 0.01)));
    EXPECT_EQ(gain_of(contrary, "good", baseline).decision, GainDecision::poses_disagree);
    const std::vector<GainRow> of_three = gains_of(at_equal_time(some_poses({8.0, 7.0, 6.0}, {4.0, 5.0, 3.0}, 0.01)));
    EXPECT_GT(*gain_of(of_three, "better", baseline).gain_low_pct, 0.0);
    EXPECT_EQ(gain_of(of_three, "better", baseline).decision, GainDecision::few_poses);
}

TEST(Gains, AreThoseOfEachBodyTooAndChangesThatAreTooSlowInSomePoseAreNotRanked)
{
    std::vector<PointRow> points = some_poses({8.0, 7.0, 6.0, 7.0}, {4.0, 5.0, 3.0, 4.0}, 0.01);
    for (const std::string group : {"all", "limb", "human"})
        EXPECT_EQ(std::ranges::count_if(gains_of(at_equal_time(points)),
                                        [&](const GainRow& gain) { return gain.group == group && gain.than == baseline; }),
                  3 * 3)
            << "two changes and the control, at three budgets";
    points.push_back(change_point(limb_twist_pose, "in_one_pose", "", 1, 0.5, 0.1));
    const std::vector<GainRow> gains = gains_of(at_equal_time(points));
    EXPECT_EQ(gain_of(gains, "in_one_pose", baseline).poses, 1);
    EXPECT_FALSE(gain_of(gains, "in_one_pose", baseline).gain_low_pct) << "one pose has no interval";
    EXPECT_EQ(gain_of(gains, "better", "good").poses, 4);
}

}  // namespace

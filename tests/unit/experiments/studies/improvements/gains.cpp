// Reference: means and intervals of a few poses by hand; the influence of the reference's error by moving a point into every direction.
#include "experiments/studies/work_precision/gains.hpp"

#include "experiments/studies/improvements/gains_page.hpp"
#include "tests/support/change_points.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace {

using namespace experiments;
using namespace test_support;

// A and B at a and b from the reference on a line through it: moving the reference by U changes |A - x| - |B - x| by 0 on the same side of
// both and by 2 U between them. The bound must be at least that, and no more than 2 U.
TEST(Gains, ShiftBoundsWhatTheReferenceMayChange)
{
    EXPECT_FALSE(shift_of_difference(5.0, 6.0, 1.0, std::nullopt));
    EXPECT_DOUBLE_EQ(*shift_of_difference(5.0, 7.0, 12.0, 0.5), 1.0) << "on opposite sides: 2 U";
    EXPECT_LT(*shift_of_difference(5.0, 7.0, 2.0, 0.5), 0.2) << "on the same side it is small: 2 * 2 / 11 * 0.5";
    EXPECT_DOUBLE_EQ(*shift_of_difference(0.4, 0.3, 0.1, 0.5), 1.0) << "within the bound nothing is known";
    EXPECT_EQ(*shift_of_difference(5.0, 5.0, 0.0, 0.5), 0.0) << "the same shape";
}

// By sampling: two shapes in the plane, the reference moved by U into every direction.
TEST(Gains, ShiftHoldsForEveryDirection)
{
    const double bound = 0.7;
    for (const auto& [ax, ay, bx, by] : {std::array{3.0, 0.0, 2.0, 2.0}, {1.0, 1.0, -4.0, 0.5}, {5.0, 0.1, 4.0, -0.1}}) {
        const double one = std::hypot(ax, ay), other = std::hypot(bx, by), distance = std::hypot(ax - bx, ay - by);
        const double shift = *shift_of_difference(one, other, distance, bound);
        double largest = 0.0;
        for (int degree = 0; degree < 360; ++degree) {
            const double x = bound * std::cos(degree * M_PI / 180), y = bound * std::sin(degree * M_PI / 180);
            const double moved = std::hypot(ax - x, ay - y) - std::hypot(bx - x, by - y);
            largest = std::max(largest, std::abs(moved - (one - other)));
        }
        EXPECT_LE(largest, shift);
        EXPECT_GT(largest, 0.0);
    }
}

std::vector<ChangePoint> some_poses(const std::vector<double>& good, const std::vector<double>& better, double bound_pct)
{
    std::vector<ChangePoint> points;
    const std::vector<CaseKey> poses = {limb_twist_pose, limb_bend_pose, human_crouch_pose, human_standing_pose};
    for (std::size_t i = 0; i < good.size(); ++i) {
        add_baseline(points, poses[i]);
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

TEST(Gains, AreUndecidedWithinTheReferencesOwnError)
{
    const std::vector<GainRow> gains = gains_of(at_equal_time(some_poses({8.0, 7.0, 6.0, 7.0}, {4.0, 5.0, 3.0, 4.0}, 4.0)));
    EXPECT_EQ(gain_of(gains, "better", "good").decision, GainDecision::reference_error);
    std::vector<ChangePoint> unknown = some_poses({8.0, 7.0, 6.0, 7.0}, {4.0, 5.0, 3.0, 4.0}, 0.01);
    for (ChangePoint& point : unknown) point.reference_error_joint_pct.reset();
    EXPECT_EQ(gain_of(gains_of(at_equal_time(unknown)), "better", baseline).decision, GainDecision::reference_error);
}

TEST(Gains, AreUndecidedWhereThePosesDisagree)
{
    const std::vector<GainRow> gains = gains_of(at_equal_time(some_poses({2.0, 18.0, 5.0, 11.0}, {4.0, 17.0, 6.0, 12.0}, 0.01)));
    EXPECT_EQ(gain_of(gains, "good", baseline).decision, GainDecision::poses_disagree);
}

TEST(Gains, OfFewerThanFourPosesAreUndecided)
{
    const std::vector<GainRow> gains = gains_of(at_equal_time(some_poses({8.0, 7.0, 6.0}, {4.0, 5.0, 3.0}, 0.01)));
    EXPECT_GT(*gain_of(gains, "better", baseline).gain_low_pct, 0.0);
    EXPECT_EQ(gain_of(gains, "better", baseline).decision, GainDecision::few_poses);
}

TEST(Gains, AreThoseOfEachBodyToo)
{
    const std::vector<GainRow> gains = gains_of(at_equal_time(some_poses({8.0, 7.0, 6.0, 7.0}, {4.0, 5.0, 3.0, 4.0}, 0.01)));
    for (const std::string group : {"all", "limb", "human"})
        EXPECT_EQ(std::ranges::count_if(gains, [&](const GainRow& gain) { return gain.group == group && gain.than == baseline; }), 3 * 3)
            << "two changes and the control, at three budgets";
}

TEST(Gains, PageNamesTheBestChangeAndWhetherItIsDecided)
{
    const auto page = [](const std::vector<double>& good, double bound_pct) {
        return gains_page(gains_of(at_equal_time(some_poses(good, {4.0, 5.0, 3.0, 4.0}, bound_pct))));
    };
    EXPECT_NE(page({8.0, 7.0, 6.0, 7.0}, 0.01).find("The change with the largest mean gain is better: over 4 poses"), std::string::npos);
    EXPECT_NE(page({8.0, 7.0, 6.0, 7.0}, 0.01).find("[decided]"), std::string::npos);
    EXPECT_NE(page({1.0, 1.0, 1.0, 1.0}, 0.01).find("The change with the largest mean gain is good: over 4 poses"), std::string::npos);
    EXPECT_NE(page({8.0, 7.0, 6.0, 7.0}, 9.0).find("the reference's own error may change it by"), std::string::npos);
    EXPECT_NE(page({-8.0, 7.0, -6.0, 7.0}, 0.01).find("[undecided: the interval over the poses includes zero]"), std::string::npos);
    const std::string worse = gains_page(gains_of(at_equal_time(some_poses({12.0, 13.0, 12.0, 11.0}, {14.0, 15.0, 14.0, 13.0}, 0.01))));
    EXPECT_NE(
        worse.find(
            "The mean error of the baseline over 4 poses is 10.00 %, and no single change reduces it. The best change, good, gains -2.00"),
        std::string::npos);
}

TEST(Gains, ChangesThatAreTooSlowInSomePoseAreNotRanked)
{
    std::vector<ChangePoint> points = some_poses({8.0, 7.0, 6.0, 7.0}, {4.0, 5.0, 3.0, 4.0}, 0.01);
    points.push_back(change_point(limb_twist_pose, "in_one_pose", "", 1, 0.5, 0.1));
    const std::vector<GainRow> gains = gains_of(at_equal_time(points));
    EXPECT_EQ(gain_of(gains, "in_one_pose", baseline).poses, 1);
    EXPECT_FALSE(gain_of(gains, "in_one_pose", baseline).gain_low_pct) << "one pose has no interval";
    EXPECT_EQ(gain_of(gains, "better", "good").poses, 4);
    const std::string page = gains_page(gains);
    EXPECT_NE(page.find("Not ranked, because no setting fits into the budget in every pose: in one pose (1 of 4 poses).\n"),
              std::string::npos);
    EXPECT_NE(page.find("in one pose (0 of 2 poses)"), std::string::npos) << "the poses of the other body";
}

TEST(Gains, APageWithEveryChangeInEveryPoseHasNoOmission)
{
    const std::string page = gains_page(gains_of(at_equal_time(some_poses({8.0, 7.0, 6.0, 7.0}, {4.0, 5.0, 3.0, 4.0}, 0.01))));
    EXPECT_EQ(page.find("Not ranked"), std::string::npos);
}

}  // namespace

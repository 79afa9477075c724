// Reference: curves of error over time whose values at a budget, choices and gains are computed by hand.
#include "experiments/studies/improvements/equal_time.hpp"

#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

using namespace experiments;
using analysis::CaseKey;

const CaseKey twist = {.body = "limb", .motion = "twist", .angle_deg = 90.0}, bend = {.body = "limb", .motion = "bend", .angle_deg = 60.0},
              crouch = {.body = "human", .motion = "01_01", .pose = "crouch"},
              standing = {.body = "human", .motion = "01_01", .pose = "standing"};

ChangePoint point(const CaseKey& of, const std::string& change, const std::string& setting, int iterations, double ms, double error_pct,
                  std::optional<double> bound_pct = 0.01, double distance_pct = 1.0)
{
    ChangePoint point;
    point.of = of;
    point.change = change;
    point.setting = setting;
    point.iterations = iterations;
    point.ms.median = ms;
    if (std::isfinite(error_pct)) point.error_joint_pct = error_pct;
    point.distance_pct.fill(distance_pct);
    point.reference_error_joint_pct = bound_pct;
    return point;
}

// The baseline takes 1, 6 and 24 ms for 4, 24 and 96 iterations and has an error of 10 % throughout.
void add_baseline(std::vector<ChangePoint>& points, const CaseKey& of)
{
    for (const int iterations : budget_iterations) points.push_back(point(of, baseline, "", iterations, iterations / 4.0, 10.0));
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
    std::vector<ChangePoint> points;
    add_baseline(points, twist);
    points.push_back(point(twist, "slower", "", 1, 3.0, 9.0));
    points.push_back(point(twist, "slower", "", 5, 12.0, 5.0));  // 6 ms are halfway between 3 and 12
    const std::vector<EqualTimeRow> rows = at_equal_time(points);
    const double rounding = test_support::rounding_error(10, 10.0);
    EXPECT_EQ(row_of(rows, 4, "slower", twist), nullptr) << "its first point takes longer than 1 ms";
    ASSERT_NE(row_of(rows, 24, "slower", twist), nullptr);
    EXPECT_NEAR(row_of(rows, 24, "slower", twist)->error_pct, 7.0, rounding);
    EXPECT_NEAR(row_of(rows, 24, "slower", twist)->iterations, 3.0, rounding);
    EXPECT_NEAR(row_of(rows, 24, "slower", twist)->gain_pct(), 3.0, rounding);
    EXPECT_EQ(row_of(rows, 96, "slower", twist)->error_pct, 5.0) << "after the last point the error stays";
    EXPECT_EQ(row_of(rows, 96, "slower", twist)->iterations, 5.0);
}

TEST(EqualTime, ChoosesASettingOnTheOtherPoses)
{
    std::vector<ChangePoint> points;
    for (const CaseKey& of : {twist, bend, crouch}) {
        add_baseline(points, of);
        points.push_back(point(of, "change", "a", 1, 0.5, of == twist ? 1.0 : 8.0));
        points.push_back(point(of, "change", "b", 1, 0.5, of == twist ? 9.0 : 4.0));
    }
    const std::vector<EqualTimeRow> rows = at_equal_time(points);
    EXPECT_EQ(row_of(rows, 24, "change", twist)->setting, "b") << "a is best in this pose and worst in the others";
    EXPECT_EQ(row_of(rows, 24, "change", twist)->error_pct, 9.0);
    EXPECT_EQ(row_of(rows, 24, "change", bend)->setting, "a");
    EXPECT_EQ(row_of(rows, 24, "change", crouch)->setting, "a");
}

TEST(EqualTime, EachBodyChoosesOnItsOwnPosesToo)
{
    std::vector<ChangePoint> points;
    for (const CaseKey& of : {twist, bend, crouch, standing}) {
        add_baseline(points, of);
        points.push_back(point(of, "change", "of_the_limb", 1, 0.5, of.body == "limb" ? 1.0 : 8.0));
        points.push_back(point(of, "change", "of_the_human", 1, 0.5, of.body == "limb" ? 9.0 : 1.0));
    }
    for (const EqualTimeRow& row : at_equal_time(points))
        if (row.group != all_poses) {
            EXPECT_EQ(row.group, row.of.body);
            EXPECT_EQ(row.setting, "of_the_" + row.group);
        }
    const std::vector<GainRow> gains = gains_of(at_equal_time(points));
    EXPECT_EQ(std::ranges::count(gains, "human", &GainRow::group), 3) << "one for each budget";
}

TEST(EqualTime, APoseWithoutAnErrorHasNoValue)
{
    std::vector<ChangePoint> points;
    add_baseline(points, twist);
    points.push_back(point(twist, "broken", "", 1, 0.5, std::nan("")));
    EXPECT_EQ(row_of(at_equal_time(points), 24, "broken", twist), nullptr);
}

TEST(EqualTime, ASettingThatIsMissingInAnotherPoseIsNotChosen)
{
    std::vector<ChangePoint> points;
    for (const CaseKey& of : {twist, bend}) {
        add_baseline(points, of);
        points.push_back(point(of, "change", "b", 1, 0.5, 5.0));
    }
    points.push_back(point(twist, "change", "a", 1, 0.5, 1.0));
    EXPECT_EQ(row_of(at_equal_time(points), 24, "change", twist)->setting, "b");
}

// A and B at a and b from the reference on a line through it: moving the reference by U changes |A - x| - |B - x| by 0 on the same side of
// both and by 2 U between them. The bound must be at least that, and no more than 2 U.
TEST(EqualTime, ShiftBoundsWhatTheReferenceMayChange)
{
    EXPECT_FALSE(shift_of_difference(5.0, 6.0, 1.0, std::nullopt));
    EXPECT_DOUBLE_EQ(*shift_of_difference(5.0, 7.0, 12.0, 0.5), 1.0) << "on opposite sides: 2 U";
    EXPECT_LT(*shift_of_difference(5.0, 7.0, 2.0, 0.5), 0.2) << "on the same side it is small: 2 * 2 / 11 * 0.5";
    EXPECT_DOUBLE_EQ(*shift_of_difference(0.4, 0.3, 0.1, 0.5), 1.0) << "within the bound nothing is known";
    EXPECT_EQ(*shift_of_difference(5.0, 5.0, 0.0, 0.5), 0.0) << "the same shape";
}

// By sampling: two shapes in the plane, the reference moved by U into every direction.
TEST(EqualTime, ShiftHoldsForEveryDirection)
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
    const std::vector<CaseKey> poses = {twist, bend, crouch, standing};
    for (std::size_t i = 0; i < good.size(); ++i) {
        add_baseline(points, poses[i]);
        points.push_back(point(poses[i], "good", "", 1, 0.5, good[i], bound_pct));
        points.push_back(point(poses[i], "better", "", 1, 0.5, better[i], bound_pct));
        points.push_back(point(poses[i], control, "k_bind 0.5", 1, 0.5, 0.5, bound_pct));
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
    EXPECT_EQ(gain_of(gains, "good", baseline).decision, GainDecision::few_poses);
}

TEST(Gains, OfFewerThanFourPosesAreUndecided)
{
    const std::vector<GainRow> gains = gains_of(at_equal_time(some_poses({8.0, 7.0, 6.0}, {4.0, 5.0, 3.0}, 0.01)));
    EXPECT_GT(*gain_of(gains, "better", baseline).gain_low_pct, 0.0);
    EXPECT_EQ(gain_of(gains, "better", baseline).decision, GainDecision::few_poses);
}

TEST(Gains, ChangesThatAreTooSlowInSomePoseAreNotRanked)
{
    std::vector<ChangePoint> points = some_poses({8.0, 7.0, 6.0, 7.0}, {4.0, 5.0, 3.0, 4.0}, 0.01);
    points.push_back(point(twist, "in_one_pose", "", 1, 0.5, 0.1));
    const std::vector<GainRow> gains = gains_of(at_equal_time(points));
    EXPECT_EQ(gain_of(gains, "in_one_pose", baseline).poses, 1);
    EXPECT_FALSE(gain_of(gains, "in_one_pose", baseline).gain_low_pct) << "one pose has no interval";
    EXPECT_EQ(gain_of(gains, "better", "good").poses, 4);
}

}  // namespace

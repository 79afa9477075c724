// Reference: curves of error over time whose values at a budget and choices are computed by hand.
#include "experiments/studies/work_precision/gains.hpp"

#include "tests/support/change_points.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace {

using namespace experiments;
using namespace test_support;

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
    add_baseline(points, limb_twist_pose);
    points.push_back(change_point(limb_twist_pose, "slower", "", 1, 3.0, 9.0));
    points.push_back(change_point(limb_twist_pose, "slower", "", 5, 12.0, 5.0));  // 6 ms are halfway between 3 and 12
    const std::vector<EqualTimeRow> rows = at_equal_time(points);
    const double rounding = test_support::rounding_error(10, 10.0);
    EXPECT_EQ(row_of(rows, 4, "slower", limb_twist_pose), nullptr) << "its first point takes longer than 1 ms";
    ASSERT_NE(row_of(rows, 24, "slower", limb_twist_pose), nullptr);
    EXPECT_NEAR(row_of(rows, 24, "slower", limb_twist_pose)->error_pct, 7.0, rounding);
    EXPECT_NEAR(row_of(rows, 24, "slower", limb_twist_pose)->iterations, 3.0, rounding);
    EXPECT_NEAR(row_of(rows, 24, "slower", limb_twist_pose)->gain_pct(), 3.0, rounding);
    EXPECT_EQ(row_of(rows, 96, "slower", limb_twist_pose)->error_pct, 5.0) << "after the last point the error stays";
    EXPECT_EQ(row_of(rows, 96, "slower", limb_twist_pose)->iterations, 5.0);
}

TEST(EqualTime, ChoosesASettingOnTheOtherPoses)
{
    std::vector<ChangePoint> points;
    for (const CaseKey& of : {limb_twist_pose, limb_bend_pose, human_crouch_pose}) {
        add_baseline(points, of);
        points.push_back(change_point(of, "change", "a", 1, 0.5, of == limb_twist_pose ? 1.0 : 8.0));
        points.push_back(change_point(of, "change", "b", 1, 0.5, of == limb_twist_pose ? 9.0 : 4.0));
    }
    const std::vector<EqualTimeRow> rows = at_equal_time(points);
    EXPECT_EQ(row_of(rows, 24, "change", limb_twist_pose)->setting, "b") << "a is best in this pose and worst in the others";
    EXPECT_EQ(row_of(rows, 24, "change", limb_twist_pose)->error_pct, 9.0);
    EXPECT_EQ(row_of(rows, 24, "change", limb_bend_pose)->setting, "a");
    EXPECT_EQ(row_of(rows, 24, "change", human_crouch_pose)->setting, "a");
}

TEST(EqualTime, EachBodyChoosesOnItsOwnPosesToo)
{
    std::vector<ChangePoint> points;
    for (const CaseKey& of : {limb_twist_pose, limb_bend_pose, human_crouch_pose, human_standing_pose}) {
        add_baseline(points, of);
        points.push_back(change_point(of, "change", "of_the_limb", 1, 0.5, of.body == "limb" ? 1.0 : 8.0));
        points.push_back(change_point(of, "change", "of_the_human", 1, 0.5, of.body == "limb" ? 9.0 : 1.0));
    }
    for (const EqualTimeRow& row : at_equal_time(points))
        if (row.group != all_poses) {
            EXPECT_EQ(row.group, row.of.body);
            EXPECT_EQ(row.setting, "of_the_" + row.group);
        }
}

TEST(EqualTime, APoseWithoutAnErrorHasNoValue)
{
    std::vector<ChangePoint> points;
    add_baseline(points, limb_twist_pose);
    points.push_back(change_point(limb_twist_pose, "broken", "", 1, 0.5, std::nan("")));
    EXPECT_EQ(row_of(at_equal_time(points), 24, "broken", limb_twist_pose), nullptr);
}

TEST(EqualTime, ASettingThatIsMissingInAnotherPoseIsNotChosen)
{
    std::vector<ChangePoint> points;
    for (const CaseKey& of : {limb_twist_pose, limb_bend_pose}) {
        add_baseline(points, of);
        points.push_back(change_point(of, "change", "b", 1, 0.5, 5.0));
    }
    points.push_back(change_point(limb_twist_pose, "change", "a", 1, 0.5, 1.0));
    EXPECT_EQ(row_of(at_equal_time(points), 24, "change", limb_twist_pose)->setting, "b");
}

}  // namespace

// Reference: the goal of 5 % within 3 ms, applied by hand to a few points.
#include "experiments/studies/work_precision/goal.hpp"

#include "tests/support/comparison_records.hpp"

#include <gtest/gtest.h>

namespace {

using namespace experiments;
using test_support::hand_case;
using test_support::hand_diagrams;
using test_support::hand_reference;

SettingKey pbs_after(int iterations, std::optional<int> wanted_vertices = {})
{
    SettingKey key = {.deformer = "pbs", .iterations = iterations, .precision = "f64"};
    key.wanted_vertices = wanted_vertices;
    return key;
}

const SettingKey linear_tets = {.deformer = "fem_neo_hookean", .precision = "f64", .element_order = 1};

// Within 3 ms PBS has 5 % in the first pose and 7 % in the second one. There its linear elements have 6 %, and a finer mesh has 4 % after
// 8 ms. Nothing is within 5 % in the third pose.
std::vector<Diagram> three_poses()
{
    return hand_diagrams({hand_case({.body = "limb", .pose = "a"},
                                    {{pbs_after(1), 1.0, 9.0}, {pbs_after(4), 3.0, 5.0}, {pbs_after(8), 5.0, 1.0}, hand_reference()}),
                          hand_case({.body = "limb", .pose = "b"},
                                    {{pbs_after(1), 1.0, 7.0},
                                     {pbs_after(4), 3.1, 6.5},
                                     {pbs_after(4, 5000), 8.0, 4.0},
                                     {linear_tets, 500.0, 6.0},
                                     hand_reference()},
                                    Half::training),
                          hand_case({.body = "limb", .pose = "c"}, {{pbs_after(1), 4.0, 7.0}, hand_reference()})});
}

const GoalRow* row_of(const std::vector<GoalRow>& rows, const std::string& pose, GoalPoint which)
{
    for (const GoalRow& row : rows)
        if (row.comparison == Comparison::plain_f64 && row.diagram == case_name({.body = "limb", .pose = pose}) && row.which == which)
            return &row;
    return nullptr;
}

TEST(Goal, IsJudgedByTheNearestPointWithinTheTime)
{
    const std::vector<GoalRow> rows = goal_rows(three_poses());
    const GoalRow *reached = row_of(rows, "a", GoalPoint::nearest_within_time), *missed = row_of(rows, "b", GoalPoint::nearest_within_time);
    ASSERT_TRUE(reached && missed);
    EXPECT_EQ(reached->point.key, pbs_after(4));
    EXPECT_TRUE(reached->reaches_goal) << "3 ms and 5 % are within the goal";
    EXPECT_FALSE(reached->linear_elements_pct) << "there are no linear elements in this pose";
    EXPECT_EQ(missed->point.key, pbs_after(1));
    EXPECT_FALSE(missed->reaches_goal);
    EXPECT_EQ(missed->half, Half::training);
}

TEST(Goal, HasTheFinerMeshWithItsTimeWhereTheOwnTetsCannotReachIt)
{
    const std::vector<GoalRow> rows = goal_rows(three_poses());
    const GoalRow *own = row_of(rows, "a", GoalPoint::fastest_within_error), *finer = row_of(rows, "b", GoalPoint::fastest_within_error);
    ASSERT_TRUE(own && finer);
    EXPECT_EQ(own->point.key, pbs_after(4));
    EXPECT_EQ(finer->point.key, pbs_after(4, 5000));
    EXPECT_EQ(finer->point.ms, 8.0);
    EXPECT_EQ(finer->linear_elements_pct, std::optional(6.0));
    EXPECT_FALSE(finer->reaches_goal);
}

TEST(Goal, HasNoRowWhereNoPointFulfilsTheCondition)
{
    const std::vector<GoalRow> rows = goal_rows(three_poses());
    EXPECT_EQ(row_of(rows, "c", GoalPoint::nearest_within_time), nullptr);
    EXPECT_EQ(row_of(rows, "c", GoalPoint::fastest_within_error), nullptr);
    const std::string text = goal_text(three_poses(), Comparison::plain_f64);
    EXPECT_NE(text.find("| none | | | none | | |"), std::string::npos) << text;
    EXPECT_NE(text.find("| PBS | 1 of 3 |"), std::string::npos) << text;
}

// The rows of points have no distance from linear elements unless the study measured one: here 2, 0.9 and 0.1 %.
TEST(Goal, OfTheSolverIsTheDistanceFromLinearElements)
{
    CaseRows rows = hand_case({.body = "limb", .pose = "a"},
                              {{pbs_after(1), 1.0, 9.0}, {pbs_after(4), 6.0, 9.0}, {linear_tets, 500.0, 7.0}, hand_reference()});
    rows[0].to_linear_elements_pct = 2.0;
    rows[1].to_linear_elements_pct = 0.9;
    rows[2].to_linear_elements_pct = 0.1;
    const std::vector<GoalRow> found = goal_rows(hand_diagrams({rows}));
    const GoalRow* solver = row_of(found, "a", GoalPoint::fastest_to_linear_elements);
    ASSERT_TRUE(solver);
    EXPECT_EQ(solver->point.key, pbs_after(4));
    EXPECT_EQ(solver->newton_ms, std::optional(500.0));
    EXPECT_TRUE(solver->reaches_goal) << "6 ms are within the goal";
    EXPECT_EQ(row_of(found, "a", GoalPoint::fastest_within_error), nullptr);
}

}  // namespace

// Reference: the goals of 5 % within 3 ms, and of 1 % within 6 ms and a thirtieth of Newton's time, applied by hand to a few points.
#include "experiments/studies/work_precision/goal.hpp"

#include "experiments/studies/shared/posed_character.hpp"
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
    EXPECT_NE(text.find("| none | | | none | | | not known | | |"), std::string::npos) << "there are no linear elements:\n" << text;
    EXPECT_NE(text.find("| PBS | 1 of 3, 0 certain |"), std::string::npos) << text;
}

// Over the reference's bound of 6 % a goal of 5 % is never certain. With a bound of 1.5 % it is certain up to 3.5 %.
TEST(Goal, IsCertainWhereTheBoundOfTheReferenceAllowsIt)
{
    const auto row_with = [](double error_pct, double bound_pct) {
        const std::vector<Diagram> diagrams = hand_diagrams(
            {hand_case({.body = "limb", .pose = "a"}, {{pbs_after(1), 1.0, error_pct}, hand_reference()}, Half::evaluation, bound_pct)});
        return *row_of(goal_rows(diagrams), "a", GoalPoint::nearest_within_time);
    };
    EXPECT_TRUE(row_with(3.5, 1.5).is_certain);
    EXPECT_FALSE(row_with(3.6, 1.5).is_certain);
    EXPECT_TRUE(row_with(3.6, 1.5).reaches_goal);
    EXPECT_FALSE(row_with(1.0, 6.0).is_certain);
    EXPECT_EQ(row_with(1.0, 6.0).reference_error_pct, std::optional(6.0));
    const std::string text = goal_text(
        hand_diagrams({hand_case({.body = "limb", .pose = "a"}, {{pbs_after(1), 1.0, 3.5}, hand_reference()}, Half::evaluation, 1.5),
                       hand_case({.body = "limb", .pose = "b"}, {{pbs_after(1), 1.0, 4.0}, hand_reference()}, Half::evaluation, 1.5)}),
        Comparison::plain_f64);
    EXPECT_NE(text.find("| PBS | 2 of 2, 1 certain |"), std::string::npos) << text;
}

// The linear elements have 6 %. On meshes of 5000 vertices PBS has 5.5, 4.9 and 4.0 %, on the coarse one 3 %.
TEST(Goal, HasTheBestPointOnAFinerMeshWhereLinearElementsAreAboveIt)
{
    std::vector<test_support::HandPoint> points = {{pbs_after(1, 300), 0.1, 3.0},  {pbs_after(1, 5000), 2.0, 5.5},
                                                   {pbs_after(4, 5000), 8.0, 4.9}, {pbs_after(8, 5000), 16.0, 4.0},
                                                   {linear_tets, 500.0, 6.0},      hand_reference()};
    const auto row_with = [&]() {
        CaseRows rows = hand_case({.body = "limb", .pose = "a"}, points);
        for (PointRow& row : rows) row.vertices = row.key.wanted_vertices.value_or(1780);
        const std::vector<GoalRow> found = goal_rows(hand_diagrams({rows}));
        const GoalRow* row = row_of(found, "a", GoalPoint::best_on_finer_mesh);
        return row ? std::optional(*row) : std::nullopt;
    };
    EXPECT_EQ(row_with().value().point.key, pbs_after(4, 5000)) << "the fastest one within the goal";
    EXPECT_FALSE(row_with()->reaches_goal) << "it takes longer than the goal allows";
    points[2].error_pct = points[3].error_pct = 5.2;
    EXPECT_EQ(row_with().value().point.key, pbs_after(4, 5000)) << "the nearest one, and of equal ones the fastest";
    points[4].error_pct = 5.0;
    EXPECT_FALSE(row_with()) << "the own tets are fine enough";
    const std::string text = goal_text(hand_diagrams({hand_case({.body = "limb", .pose = "a"}, points)}), Comparison::plain_f64);
    EXPECT_NE(text.find("| not needed | | |"), std::string::npos) << text;
}

const SettingKey limit_tets = {.deformer = "fem_stable_neo_hookean", .precision = "f64", .element_order = 1};

// PBS is 2, 0.9 and 0.1 % from the own limit after 1, 6 and 8 ms. Newton's method comes there from three cold starts, and from the frame
// before in 7 ms, which does not count.
CaseRecords solver_case(double newton_ms)
{
    CaseRecords records = {hand_case({.body = "limb", .pose = "a"}, {{pbs_after(1), 1.0, 9.0},
                                                                     {pbs_after(4), 6.0, 9.0},
                                                                     {pbs_after(8), 8.0, 9.0},
                                                                     {linear_tets, 400.0, 7.0},
                                                                     {limit_tets, 500.0, 6.5},
                                                                     hand_reference()})};
    const double distances_pct[] = {2.0, 0.9, 0.1, 0.6, 0.0};
    for (std::size_t i = 0; i < 5; ++i) records.rows[i].to_linear_elements_pct = distances_pct[i];
    records.newton = {{.start = NewtonStart::smooth_dqs, .newton_steps = 5, .ms_median = newton_ms + 10.0, .to_limit_pct = 0.9},
                      {.start = NewtonStart::lbs, .newton_steps = 4, .ms_median = newton_ms - 90.0, .to_limit_pct = 1.1},
                      {.start = NewtonStart::rest, .newton_steps = 12, .ms_median = newton_ms, .to_limit_pct = 0.0},
                      {.start = NewtonStart::smooth_dqs, .newton_steps = 6, .single_steps_ms = 1.0, .to_limit_pct = 0.1},
                      {.start = NewtonStart::frame_before, .newton_steps = 1, .ms_median = 7.0, .to_limit_pct = 0.2}};
    return records;
}

std::vector<Diagram> solver_diagrams(const CaseRecords& records)
{
    return diagrams_of({records}, choose_settings({records.rows}));
}

TEST(Goal, OfTheSolverIsTheDistanceFromItsOwnLimitInAThirtiethOfNewtonsTime)
{
    for (const double newton_ms : {180.0, 179.0}) {
        const std::vector<GoalRow> found = goal_rows(solver_diagrams(solver_case(newton_ms)));
        const GoalRow* solver = row_of(found, "a", GoalPoint::fastest_to_linear_elements);
        ASSERT_TRUE(solver);
        EXPECT_EQ(solver->point.key, pbs_after(4));
        EXPECT_EQ(solver->linear_elements_pct, std::optional(7.0));
        EXPECT_EQ(solver->own_limit_pct, std::optional(6.5));
        EXPECT_EQ(solver->newton_converged_ms, std::optional(500.0));
        EXPECT_EQ(solver->newton_goal_ms, std::optional(newton_ms));
        EXPECT_EQ(solver->newton_start, std::optional(NewtonStart::rest));
        EXPECT_EQ(solver->newton_warm_ms, std::optional(7.0));
        EXPECT_EQ(solver->reaches_goal, newton_ms >= 30.0 * 6.0) << "6 ms are within the goal, and 180 ms are 30 times as long";
        EXPECT_EQ(row_of(found, "a", GoalPoint::fastest_within_error), nullptr);
    }
}

// PBS is 1.1 % away, and the finite elements of both laws are within 1 %.
TEST(Goal, OfTheSolverIsNotReachedByFiniteElements)
{
    CaseRecords records = solver_case(1e6);
    for (int i = 0; i < 3; ++i) records.rows[i].to_linear_elements_pct = 1.1;
    for (int i = 3; i < 5; ++i) records.rows[i].ms_median = 5.0;
    const std::vector<Diagram> diagrams = solver_diagrams(records);
    EXPECT_EQ(row_of(goal_rows(diagrams), "a", GoalPoint::fastest_to_linear_elements), nullptr);
    for (const DeformerGroup& group : groups_of(diagrams)) {
        const SolverSolved count = solver_goal_reached(diagrams, Comparison::plain_f64, group, "limb");
        EXPECT_EQ(std::tuple(count.solved, count.in_time), std::tuple(0, 0)) << group.key;
    }
}

TEST(Goal, OfTheSolverIsCountedForEachBody)
{
    const DeformerGroup& pbs = group_named("pbs");
    const auto count = [&](const CaseRecords& records) {
        const SolverSolved found = solver_goal_reached(solver_diagrams(records), Comparison::plain_f64, pbs, "limb");
        return std::tuple(found.solved, found.poses, found.in_time, found.unknown);
    };
    EXPECT_EQ(count(solver_case(180.0)), std::tuple(1, 1, 1, 0));
    EXPECT_EQ(count(solver_case(179.0)), std::tuple(0, 1, 1, 0));
    CaseRecords without_time = solver_case(180.0);
    without_time.newton.clear();
    EXPECT_EQ(count(without_time), std::tuple(0, 1, 1, 1));
    CaseRecords slow = solver_case(1000.0);
    slow.rows[1].ms_median = 6.1;
    EXPECT_EQ(count(slow), std::tuple(0, 1, 0, 0)) << "above 6 ms";
    const std::string text = goal_text(solver_diagrams(solver_case(180.0)), Comparison::plain_f64);
    EXPECT_NE(text.find("| PBS | 1 of 1, 1 in time |"), std::string::npos) << text;
    EXPECT_NE(text.find("| 6.5 | pbs, iterations 4, precision f64 | 6 | 0.9 | 180 | rest | 30 | yes | 7 |"), std::string::npos) << text;
}

}  // namespace

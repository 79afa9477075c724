// Reference: the rule in diagram.hpp: an order is decided if the errors differ by more than twice the bound, for every reference.
#include "experiments/studies/work_precision/diagram.hpp"

#include "tests/support/comparison_records.hpp"

#include <gtest/gtest.h>

namespace {

using namespace experiments;
using analysis::PairDecision;
using test_support::hand_case;
using test_support::hand_diagrams;
using test_support::hand_reference;

const SettingKey its_pbs = {.deformer = "pbs", .iterations = 24, .precision = "f64"}, its_mush = {"delta_mush", 20, {}, "", "f64"};

// PBS has an error of 20 %; the reference's own error is at most 6 %.
Diagram two_points(double mush_pct)
{
    return hand_diagrams({hand_case({.body = "limb", .pose = "a"}, {{its_mush, 0.5, mush_pct}, {its_pbs, 0.7, 20.0}, hand_reference()})})
        .front();
}

Decision of(const Diagram& diagram)
{
    return decision_on(diagram, diagram.points[1], diagram.points[0]);
}

// Further references: their bound, and the errors of PBS and delta mush.
Diagram with_members(Diagram diagram, const std::vector<std::tuple<double, double, double>>& members)
{
    for (std::size_t m = 0; m < members.size(); ++m) {
        const auto [bound_pct, pbs_pct, mush_pct] = members[m];
        diagram.members[m] = {true, bound_pct};
        diagram.points[1].members[m] = pbs_pct;
        diagram.points[0].members[m] = mush_pct;
    }
    return diagram;
}

TEST(Certainty, IsADifferenceOfMoreThanTwiceTheBound)
{
    EXPECT_TRUE(of(two_points(33.0)).is_decided());  // 33 - 20 > 2 x 6
    EXPECT_EQ(of(two_points(31.0)).decision, PairDecision::reference_error);
    EXPECT_EQ(of(two_points(31.0)).remark(), " [undecided: within the reference's own error of up to 6 %]");
    Diagram without = two_points(33.0);
    without.reference_error_pct.reset();
    EXPECT_EQ(of(without).remark(), " [undecided: the reference's own error is not known]");
}

TEST(Certainty, IsThatOfEveryReference)
{
    const Decision all = of(with_members(two_points(33.0), {{1.0, 10.0, 13.0}, {2.0, 10.0, 15.0}}));
    EXPECT_TRUE(all.is_decided());
    EXPECT_EQ(all.references, 3);
    EXPECT_EQ(all.remark(), "");
    const Decision silent = of(with_members(two_points(33.0), {{1.0, 10.0, 13.0}, {3.0, 10.0, 15.0}}));  // 15 - 10 < 2 x 3
    EXPECT_EQ(silent.decision, PairDecision::reference_error);
    EXPECT_EQ(silent.reason, "not decided by thinner_bones, by their own error or because they were not reached");
    const Decision contrary = of(with_members(two_points(33.0), {{1.0, 13.0, 10.0}}));
    EXPECT_EQ(contrary.decision, PairDecision::models_disagree);
    EXPECT_EQ(contrary.reason, "the order is the other way round for stiffer_springs");
}

TEST(Certainty, AReferenceThatWasNotReachedDecidesNothing)
{
    Diagram unreached = two_points(33.0);
    unreached.members[4] = {true, std::nullopt};
    EXPECT_EQ(of(unreached).reason, "not decided by nu_0.49, by their own error or because they were not reached");
}

TEST(Certainty, FromATimeOnIsTheWorstOfAllLaterTimes)
{
    const std::vector<test_support::HandPoint> points = {
        {its_mush, 0.5, 33.0}, {its_pbs, 0.7, 20.0}, {{"delta_mush", 50, {}, "", "f64"}, 2.0, 21.0}, hand_reference()};
    const Diagram closer = hand_diagrams({hand_case({.body = "limb", .pose = "a"}, points)}).front();
    EXPECT_TRUE(decision_from(two_points(33.0), group_of("pbs"), group_of("delta_mush"), 0.7)->is_decided());
    EXPECT_FALSE(decision_from(closer, group_of("pbs"), group_of("delta_mush"), 0.7)->is_decided());
    EXPECT_FALSE(decision_from(closer, group_of("pbs"), group_of("dqs"), 0.0));
}

}  // namespace

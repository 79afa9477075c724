// Reference: the description in claim_changes.hpp; the values are invented.
#include "experiments/studies/ambiguity/claim_changes.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace {

using analysis::Extent;
using experiments::ClaimChange;
using experiments::JudgedValue;
using experiments::Reading;
using experiments::ReadingValues;

const Reading reading = {.place = "Eq. 2", .name = "B", .baseline = "A", .options = {}};

JudgedValue value(double value, Extent extent, analysis::Limit limit = analysis::Limit::none)
{
    return {"C09", "damping_ratio", {.body = "limb"}, "1", "0.0001 to 1", value, extent, limit};
}

std::vector<ClaimChange> compared(const ReadingValues& a, const ReadingValues& b)
{
    return experiments::claim_changes("limb", "C09", reading, a, b);
}

TEST(ClaimChanges, HoldBothValuesAndFlipWhereTheBoundJudgesThemOtherwise)
{
    const auto table = compared({{value(0.5, Extent::whole)}}, {{value(1.25, Extent::none, analysis::Limit::at_least)}});
    ASSERT_EQ(table.size(), 1u);
    EXPECT_EQ(table.at(0).place, "Eq. 2");
    EXPECT_EQ(table.at(0).change, 0.75);
    EXPECT_EQ(table.at(0).b_over_a, 2.5);
    EXPECT_EQ(table.at(0).holds_a, "whole");
    EXPECT_EQ(table.at(0).holds_b, "none");
    EXPECT_EQ(table.at(0).verdict_flips, "yes");
    EXPECT_EQ(table.at(0).reason, "B: at_least");
}

TEST(ClaimChanges, DoNotFlipWithinTheBound)
{
    EXPECT_EQ(compared({{value(0.5, Extent::whole)}}, {{value(0.6, Extent::whole)}}).at(0).verdict_flips, "no");
}

TEST(ClaimChanges, WithoutAFigureOfEitherSayWhoseIsMissing)
{
    const auto of_a_alone = compared({{value(0.5, Extent::whole)}}, {});
    EXPECT_EQ(of_a_alone.at(0).verdict_flips, "no_value");
    EXPECT_EQ(of_a_alone.at(0).reason, "B has no such value");
    EXPECT_FALSE(of_a_alone.at(0).b.has_value());
    EXPECT_FALSE(of_a_alone.at(0).change.has_value());
    const auto of_b_alone = compared({}, {{value(0.5, Extent::whole)}});
    EXPECT_EQ(of_b_alone.at(0).reason, "A has no such value");
    EXPECT_EQ(of_b_alone.at(0).b, 0.5);
}

TEST(ClaimChanges, OfAClaimWithoutAFigureHaveARowThatSaysSo)
{
    const auto table = compared({}, {});
    ASSERT_EQ(table.size(), 1u);
    EXPECT_EQ(table.at(0).verdict_flips, "no_value");
    EXPECT_EQ(table.at(0).reason, "neither reading has a value");
}

TEST(ClaimChanges, OfAQuantityThatIsLeftOutHaveARowWithTheReason)
{
    const ReadingValues measured = {{value(0.5, Extent::whole)}, false, {{"C09", "share", "four settings"}, {"C12", "other", "why"}}};
    const auto table = compared(measured, measured);
    ASSERT_EQ(table.size(), 2u);
    EXPECT_EQ(table.at(0).verdict_flips, "no");
    EXPECT_EQ(table.at(1).quantity, "share");
    EXPECT_EQ(table.at(1).verdict_flips, "no_value");
    EXPECT_EQ(table.at(1).reason, "four settings");
    EXPECT_FALSE(table.at(1).b.has_value());
}

TEST(ClaimChanges, OfAReadingThatBreaksDownFlipWhatHeld)
{
    const ReadingValues broken = {{}, true};
    const auto held = compared({{value(0.5, Extent::whole)}}, broken), failed = compared({{value(2.0, Extent::none)}}, broken);
    EXPECT_EQ(held.at(0).verdict_flips, "yes");
    EXPECT_EQ(failed.at(0).verdict_flips, "no");
    EXPECT_EQ(held.at(0).reason, "B breaks down");
    EXPECT_FALSE(held.at(0).b.has_value());
    const auto with_a_value =
        compared({{value(0.5, Extent::whole)}}, {{value(std::numeric_limits<double>::quiet_NaN(), Extent::none)}, true});
    EXPECT_EQ(with_a_value.at(0).verdict_flips, "yes");
    EXPECT_EQ(with_a_value.at(0).reason, "B breaks down");
    EXPECT_EQ(compared({}, broken).at(0).reason, "B breaks down");
}

TEST(ClaimChanges, OfAFigureThatWasZeroHaveNoRatio)
{
    const auto table = compared({{value(0.0, Extent::none)}}, {{value(0.5, Extent::whole)}});
    EXPECT_FALSE(table.at(0).b_over_a.has_value());
    EXPECT_EQ(table.at(0).change, 0.5);
}

TEST(ClaimChanges, OfAReadingThatCannotTouchTheClaimSayWhy)
{
    const ClaimChange row = experiments::untouched_claim("limb", "C10", reading, "another factor is no more work");
    EXPECT_EQ(row.verdict_flips, "not_touched");
    EXPECT_EQ(row.reason, "another factor is no more work");
}

TEST(ClaimChanges, KeepCasesOfOneQuantityApart)
{
    JudgedValue a = value(0.5, Extent::whole), other = value(0.7, Extent::whole);
    other.of = {.body = "human"};
    const auto table = compared({{a, other}}, {{other, a}});
    ASSERT_EQ(table.size(), 2u);
    EXPECT_EQ(table.at(0).change, 0.0);
    EXPECT_EQ(table.at(1).change, 0.0);
}

}  // namespace

// Reference: the description in claim_changes.hpp; the values are invented.

#include "experiments/studies/ambiguity/claim_changes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <sstream>
#include <stdexcept>

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

// Reference: claims.toml and the rules of analysis::judge_case.

using experiments::judged;

TEST(JudgedValue, IsOfWhatAClaimIsJudgedByAlone)
{
    const auto values = judged({{"C09", "damping_ratio", {.body = "limb"}, 0.5, 0.5, 0.5, "1"},
                                {"C09", "frequency_hz", {.body = "limb"}, 14.0, 14.0, 14.0, "Hz"}});
    ASSERT_EQ(values.size(), 1u);
    EXPECT_EQ(values[0].quantity, "damping_ratio");
    EXPECT_EQ(values[0].extent, Extent::whole);
    EXPECT_EQ(judged({{"C09", "damping_ratio", {.body = "limb"}, 2.0, 2.0, 2.0, "1"}})[0].extent, Extent::none);
}

// A value of A and one of B belong together whether or not a tolerance was reached.
TEST(JudgedValue, KeepsABoundApartFromWhatItIsOf)
{
    const analysis::CaseKey of = {.body = "limb", .initial_guess = "rest_pose"};
    const auto values = judged({{"C03", "iterations_over_lbs_guess", of, 30.0, 30.0, 30.0, "1", "", analysis::Limit::at_least}});
    EXPECT_EQ(values[0].of, of);
    EXPECT_EQ(values[0].limit, analysis::Limit::at_least);
}

TEST(JudgedValue, LeavesOutWhatIsNotMeasured)
{
    const auto left_out = experiments::all_but("C12", {}, "why");
    ASSERT_EQ(left_out.size(), 1u);
    EXPECT_EQ(left_out[0].quantity, "iterations_to_tolerance");
    EXPECT_TRUE(experiments::all_but("C12", {"iterations_to_tolerance"}, "why").empty());
}

TEST(DigestOfClaims, IsAnotherWithAnotherBoundAndTheSameWithOtherWords)
{
    const analysis::Claim claim = experiments::claim_named("C09");
    const std::string digest = experiments::digest_of({claim});
    const auto changed = [&](const auto& change) {
        analysis::Claim other = claim;
        change(other);
        return experiments::digest_of({other});
    };
    EXPECT_NE(changed([](auto& c) { c.bounds.at(0).low -= 1e-3; }), digest);
    EXPECT_NE(changed([](auto& c) { c.bounds.pop_back(); }), digest);
    EXPECT_NE(changed([](auto& c) { c.low -= 1e-3; }), digest);
    EXPECT_NE(changed([](auto& c) { c.high += 1e-3; }), digest);
    EXPECT_NE(changed([](auto& c) { c.share = 0.9; }), digest);
    EXPECT_NE(changed([](auto& c) { c.metrics.pop_back(); }), digest);
    EXPECT_EQ(changed([](auto& c) { c.statement += "!"; }), digest);
    EXPECT_NE(experiments::digest_of({claim, experiments::claim_named("C10")}), digest);
}

experiments::ReadMotion clip_of(double change_pct)
{
    experiments::ReadMotion moved;
    for (auto* record : {&moved.pbs, &moved.lbs})
        for (int frame = 0; frame < 100; ++frame) {
            record->scene = "walk";
            record->frame.push_back(frame);
            record->time_s.push_back(0.2 * frame);
            record->volume_change_pct.push_back(change_pct);
            record->volume_abs_change_pct.push_back(std::abs(change_pct));
            record->inverted_tets.push_back(0.0);
        }
    moved.pbs.iterations = 24;
    return moved;
}

TEST(JudgedValue, OfVolumeIsTheMeanOfC01AndTheShareOfC02)
{
    const auto values = judged(clip_of(-14.0));
    ASSERT_EQ(values.size(), 4u);
    EXPECT_EQ(values[0].quantity, "mean_volume_loss_pct");
    EXPECT_EQ(values[0].value, 14.0);
    EXPECT_EQ(values[0].extent, Extent::whole);
    EXPECT_EQ(values[2].quantity, "share_of_frames_by_volume_change_pct");
    EXPECT_EQ(values[2].value, 0.0);
    EXPECT_EQ(judged(clip_of(-0.25))[2].value, 1.0);
    EXPECT_EQ(judged(clip_of(-0.25))[2].extent, Extent::whole);
}

TEST(JudgedValue, OfAReadingThatBreaksDownDoesNotHold)
{
    for (const auto& value : judged(clip_of(std::numeric_limits<double>::quiet_NaN()))) EXPECT_EQ(value.extent, Extent::none);
}

TEST(JudgedValue, OfAnUnknownClaimIsRefused)
{
    EXPECT_THROW(experiments::claim_named("C99"), std::logic_error);
}

// Reference: an invented measurement that counts its calls.

std::vector<Reading> readings()
{
    Reading own = {.place = "", .name = "own", .baseline = "own", .options = {}}, lumped = own, softer = own;
    lumped.place = softer.place = "a place";
    lumped.name = "lumped";
    lumped.options.masses = pbs::Masses::lumped;
    softer.name = "softer";
    softer.options.k_volume = 0.5;
    return {own, lumped, softer};
}

TEST(ReadingComparison, MeasuresWhatTouchesTheClaimAndItsBaselineOnce)
{
    experiments::ReadingComparison comparison("limb", readings());
    std::vector<std::string> measured;
    comparison.measure({"C10"}, [&](const std::vector<Reading>& touching) {
        std::vector<ReadingValues> values;
        for (const Reading& reading : touching) {
            measured.push_back(reading.name);
            const double ms = reading.name == "own" ? 2.0 : 3.0;
            values.push_back({{{"C10", "ms", {.body = "limb"}, "ms", "", ms, analysis::Extent::whole}}, false});
        }
        return values;
    });
    EXPECT_EQ(measured, (std::vector<std::string>{"own", "lumped"}));
    ASSERT_EQ(comparison.changes().size(), 2u);
    EXPECT_EQ(comparison.changes()[0].b_over_a, 1.5);
    EXPECT_EQ(comparison.changes()[1].verdict_flips, "not_touched");
    EXPECT_TRUE(comparison.breakdown().empty());
}

TEST(ReadingComparison, SaysWhichReadingBreaksDown)
{
    experiments::ReadingComparison comparison("limb", readings());
    comparison.measure({"C10"}, [](const std::vector<Reading>& touching) {
        return std::vector<ReadingValues>(touching.size(), ReadingValues{{}, true});
    });
    EXPECT_NE(comparison.breakdown().find("lumped (C10)"), std::string::npos);
    EXPECT_EQ(comparison.changes().at(0).reason, "B breaks down");
}

Reading named(const std::string& name)
{
    return {.place = "jiggling", .name = name, .baseline = "A", .options = {}};
}

ReadingValues with(const std::string& claim, double value, Extent extent)
{
    return {{{claim, "quantity", {.body = "limb"}, "1", "1 or more", value, extent}}, false};
}

// Appends the changes of one reading.
void add(std::vector<ClaimChange>& changes, const std::string& claim, const Reading& reading, const ReadingValues& a,
         const ReadingValues& b)
{
    std::ranges::copy(experiments::claim_changes("limb", claim, reading, a, b), std::back_inserter(changes));
}

bool has(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

TEST(ClaimChangesText, ShowsTheRatioAndMarksAFlip)
{
    std::vector<ClaimChange> changes;
    add(changes, "C02", named("B"), with("C02", 2.0, Extent::whole), with("C02", 0.5, Extent::none));
    add(changes, "C07", named("B"), with("C07", 2.0, Extent::whole), with("C07", 3.0, Extent::whole));
    const std::string text = experiments::claim_changes_text(changes);
    EXPECT_TRUE(has(text, "x0.25!")) << text;
    EXPECT_TRUE(has(text, "x1.5 ") || has(text, "x1.5\n")) << text;
    EXPECT_TRUE(has(text, "C02: 1 of 1 values flip by limb, B")) << text;
    EXPECT_TRUE(has(text, "C07: 0 of 1 values flip")) << text;
}

// A small value that flips comes before a large one that does not.
TEST(ClaimChangesText, ShowsTheFigureThatFlips)
{
    std::vector<ClaimChange> changes;
    ReadingValues a = with("C02", 1.0, Extent::whole), b = with("C02", 9.0, Extent::whole);
    a.values.push_back({"C02", "other", {.body = "limb"}, "1", "", 1.0, Extent::whole});
    b.values.push_back({"C02", "other", {.body = "limb"}, "1", "", 1.1, Extent::part});
    add(changes, "C02", named("B"), a, b);
    EXPECT_TRUE(has(experiments::claim_changes_text(changes), "x1.1!"));
}

TEST(ClaimChangesText, HasADotWhereNotTouchedAndSaysWhy)
{
    std::vector<ClaimChange> changes;
    changes.push_back(experiments::untouched_claim("limb", "C10", named("B"), "another factor is no more work"));
    const std::string text = experiments::claim_changes_text(changes);
    EXPECT_TRUE(has(text, " .\n")) << text;
    EXPECT_TRUE(has(text, "not touched where another factor is no more work")) << text;
}

TEST(ClaimChangesText, OfAClaimWithoutAValueHasADash)
{
    std::vector<ClaimChange> changes;
    add(changes, "C03", named("B"), {}, {});
    EXPECT_TRUE(has(experiments::claim_changes_text(changes), " -\n"));
}

// All quantities with the same reason share a line; the cell shows the quantity that has a value.
TEST(ClaimChangesText, SaysWhichQuantitiesAreLeftOutAndWhy)
{
    std::vector<ClaimChange> changes;
    ReadingValues a = with("C09", 2.0, Extent::whole), b = with("C09", 3.0, Extent::whole);
    a.left_out = b.left_out = {{"C09", "share", "four settings"}, {"C09", "range", "four settings"}};
    add(changes, "C09", named("B"), a, b);
    add(changes, "C09", named("other"), a, b);
    const std::string text = experiments::claim_changes_text(changes);
    EXPECT_TRUE(has(text, "no value: four settings: share, range\n")) << text;
    EXPECT_TRUE(has(text, "x1.5\n")) << text;
    EXPECT_TRUE(has(text, "C09: 0 of 2 values flip\n")) << text;
}

TEST(ClaimChangesText, OfAReadingThatBreaksDownMarksTheFlip)
{
    std::vector<ClaimChange> changes;
    add(changes, "C03", named("B"), with("C03", 2.0, Extent::whole), {{}, true});
    EXPECT_TRUE(has(experiments::claim_changes_text(changes), " -!\n"));
}

TEST(ClaimChangesText, IsAtMost120ColumnsWide)
{
    std::vector<ClaimChange> changes;
    for (const char* claim : {"C01", "C02", "C03", "C04", "C05", "C07", "C09", "C10", "C12"})
        for (int i = 0; i < 20; ++i)
            add(changes, claim, named("a reading that has a name of some length, " + std::to_string(i)), with(claim, 1.0, Extent::whole),
                with(claim, 1.234e-12, Extent::none));
    std::istringstream lines(experiments::claim_changes_text(changes));
    std::size_t widest = 0;
    for (std::string line; std::getline(lines, line);) widest = std::max(widest, line.size());
    EXPECT_LE(widest, 120u);
    EXPECT_GT(widest, 100u);
}

}  // namespace

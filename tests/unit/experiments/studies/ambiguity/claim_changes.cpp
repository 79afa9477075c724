// Reference: the description in claim_changes.hpp, and how each claim's values are measured; the values are invented.

#include "experiments/studies/ambiguity/claim_changes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace {

using analysis::Extent;
using experiments::ClaimChange;
using experiments::JudgedReading;
using experiments::JudgedValue;
using experiments::Reading;

const Reading reading = {.place = "Eq. 2", .name = "B", .baseline = "A"};

JudgedValue value(double value, Extent extent, analysis::Limit limit = analysis::Limit::none)
{
    return {"C09", "damping_ratio", {.body = "limb"}, "1", "0.0001 to 1", value, extent, limit};
}

std::vector<ClaimChange> compared(const JudgedReading& a, const JudgedReading& b)
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
}

// A value that B lacks because it breaks down does not hold.
TEST(ClaimChanges, StateWhetherTheVerdictFlipsOrWhyThereIsNoValue)
{
    const std::vector<JudgedValue> none, holds = {value(0.5, Extent::whole)}, holds_too = {value(0.6, Extent::whole)},
                                         fails = {value(2.0, Extent::none)}, zero = {value(0.0, Extent::none)},
                                         bounded = {value(1.25, Extent::none, analysis::Limit::at_least)},
                                         unknown = {value(std::numeric_limits<double>::quiet_NaN(), Extent::none)};
    struct Row {
        const char* name;
        std::vector<JudgedValue> a, b;
        bool b_broke_down;
        const char *flips, *reason;
        bool has_b, has_ratio;
    };
    const Row rows[] = {{"within the bound", holds, holds_too, false, "no", "", true, true},
                        {"only a bound", holds, bounded, false, "yes", "B: at_least", true, true},
                        {"A alone", holds, none, false, "no_value", "B has no such value", false, false},
                        {"B alone", none, holds, false, "no_value", "A has no such value", true, false},
                        {"neither", none, none, false, "no_value", "neither reading has a value", false, false},
                        {"A held", holds, none, true, "yes", "B breaks down", false, false},
                        {"A failed", fails, none, true, "no", "B breaks down", false, false},
                        {"not a number", holds, unknown, true, "yes", "B breaks down", true, true},
                        {"nothing but the breakdown", none, none, true, "no_value", "B breaks down", false, false},
                        {"A is zero", zero, holds, false, "yes", "", true, false}};
    for (const Row& row : rows) {
        SCOPED_TRACE(row.name);
        const auto table = compared({row.a}, {row.b, row.b_broke_down});
        ASSERT_EQ(table.size(), 1u);
        EXPECT_EQ(table.at(0).verdict_flips, row.flips);
        EXPECT_EQ(table.at(0).reason, row.reason);
        EXPECT_EQ(table.at(0).b.has_value(), row.has_b);
        EXPECT_EQ(table.at(0).change.has_value(), !row.a.empty() && row.has_b);
        EXPECT_EQ(table.at(0).b_over_a.has_value(), row.has_ratio);
    }
}

TEST(ClaimChanges, OfAQuantityThatIsLeftOutHaveARowWithTheReason)
{
    const JudgedReading measured = {{value(0.5, Extent::whole)}, false, {{"C09", "share", "four settings"}, {"C12", "other", "why"}}};
    const auto table = compared(measured, measured);
    ASSERT_EQ(table.size(), 2u);
    EXPECT_EQ(table.at(0).verdict_flips, "no");
    EXPECT_EQ(table.at(1).quantity, "share");
    EXPECT_EQ(table.at(1).verdict_flips, "no_value");
    EXPECT_EQ(table.at(1).reason, "four settings");
    EXPECT_FALSE(table.at(1).b.has_value());
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

TEST(JudgedValue, OfAnUnknownClaimIsRefused)
{
    EXPECT_THROW(experiments::claim_named("C99"), std::logic_error);
}

// Reference: an invented measurement that counts its calls.

std::vector<Reading> readings()
{
    const auto with = [](const std::string& place, const std::string& name, const nlohmann::json& settings) {
        return Reading{.place = place, .name = name, .baseline = "own", .settings = settings};
    };
    return {with("", "own", {{"masses", "unit"}, {"k_volume", 1.0}}), with("a place", "lumped", {{"masses", "lumped"}, {"k_volume", 1.0}}),
            with("a place", "softer", {{"masses", "unit"}, {"k_volume", 0.5}})};
}

TEST(ReadingComparison, MeasuresWhatTouchesTheClaimAndItsBaselineOnce)
{
    experiments::ReadingComparison comparison("limb", readings());
    std::vector<std::string> measured;
    comparison.measure({"C10"}, [&](const std::vector<Reading>& touching) {
        std::vector<JudgedReading> values;
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
        return std::vector<JudgedReading>(touching.size(), JudgedReading{{}, true});
    });
    EXPECT_NE(comparison.breakdown().find("lumped (C10)"), std::string::npos);
    EXPECT_EQ(comparison.changes().at(0).reason, "B breaks down");
}

// A reading belongs to a place and differs from its baseline, which comes before it.

using experiments::StudyCase;

const StudyCase limb("ambiguity",
                     {{"name", "limb"}, {"quick_s", 1.0}, {"scene", "limb_bend"}, {"overrides", {"pbs.gravity_m_s2=[0,-9.81,0]"}}}, false);

const Reading& named(const std::vector<Reading>& all, const std::string& name)
{
    const auto found = std::ranges::find(all, name, &Reading::name);
    if (found == all.end()) throw std::out_of_range(name);
    return *found;
}

TEST(Readings, DifferFromTheirBaselineWhichComesBefore)
{
    for (const char* which : {"all", "of_a_step", "of_motion"}) {
        SCOPED_TRACE(which);
        const std::vector<Reading> readings = readings_of(limb, which);
        std::vector<std::string> names;
        for (const Reading& reading : readings) {
            EXPECT_EQ(std::ranges::count(names, reading.name), 0) << reading.name;
            names.push_back(reading.name);
            ASSERT_EQ(std::ranges::count(names, reading.baseline), 1) << reading.name;
            EXPECT_EQ(reading.place.empty(), reading.name == reading.baseline);
            if (!reading.place.empty()) EXPECT_NE(reading.settings, named(readings, reading.baseline).settings) << reading.name;
        }
    }
    EXPECT_EQ(readings_of(limb, "all").size() + 1, readings_of(limb, "of_a_step").size() + readings_of(limb, "of_motion").size());
}

TEST(Readings, OfAStepRememberNothing)
{
    for (const Reading& reading : readings_of(limb, "of_a_step")) {
        EXPECT_FALSE(reading.jiggles()) << reading.name;
        EXPECT_EQ(reading.settings.at("lbs_entry"), "start") << reading.name;
    }
}

TEST(Untouched, IsAClaimWhoseValuesAReadingCannotChange)
{
    const std::vector<Reading> readings = readings_of(limb, "all");
    struct Row {
        const char* reading;
        std::vector<std::string> touched, untouched;
    };
    const Row rows[] = {{"k_stretch_0.9", {"C02", "C03", "C07", "C09"}, {"C01", "C10"}},
                        {"bones_at_either_end", {"C01", "C04", "C07", "C10"}, {"C09"}},
                        {"k_bind_0.5", {"C02", "C09"}, {"C07", "C10"}},
                        {"reprojected", {"C04", "C10"}, {"C07", "C09"}},
                        {"volume_bind_stretch", {"C10", "C12"}, {"C07"}},
                        {"lumped", {"C07", "C09", "C10"}, {"C01"}},
                        {"increment", {"C04", "C05", "C09", "C10"}, {"C01", "C03", "C07", "C12"}},
                        {"increment_without_gravity", {"C04"}, {"C03", "C07", "C12"}},
                        {"by_bone", {"C02", "C09", "C10"}, {"C03", "C04", "C05", "C07", "C12"}},
                        {"without_gravity", {"C02"}, {"C09", "C10", "C07"}},
                        {"substeps_2", {"C09", "C10"}, {"C03", "C04"}},
                        // A stiffness of zero leaves a class out, which is less work.
                        {"k_stretch_0.6_in_zone", {"C09"}, {"C10"}},
                        {"k_bind_0.5_in_zone", {"C09"}, {"C10"}},
                        {"k_bind_0_in_zone", {"C09", "C10"}, {}}};
    for (const auto& [name, touched, untouched] : rows) {
        const Reading& reading = named(readings, name);
        const auto reason = [&](const std::string& claim) { return untouched_because(claim, reading, named(readings, reading.baseline)); };
        for (const std::string& claim : touched) EXPECT_EQ(reason(claim), "") << name << " " << claim;
        for (const std::string& claim : untouched) EXPECT_NE(reason(claim), "") << name << " " << claim;
        EXPECT_EQ(untouched_because("C02", reading, reading), "the scene is so by itself");
    }
}

}  // namespace

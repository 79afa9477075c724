// Reference: the header's definition of the placeholders, with numbers chosen by hand.
#include "analysis/verdicts/headline.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace {

using namespace analysis;

JudgedCase judged_case(double value, const std::string& precision, bool holds)
{
    return {.of = {.body = "limb", .precision = precision},
            .unit = "%",
            .value = value,
            .low = value,
            .high = value,
            .n = 1,
            .holds = holds};
}

// Two of three cases hold; those of a control do not.
Verdict verdict_with(const std::string& headline)
{
    Verdict verdict{.claim = {.id = "X01", .headline = headline}};
    verdict.claim.own = {.name = "X01", .quantities = {"loss"}, .thresholds = {{.low = 12.0, .high = 16.0}}};
    verdict.claim.quantities = {{"loss", "loss", "%"}};
    verdict.claim.others = {{.name = "wrong weights", .role = Role::negative_control}};
    verdict.own = {.selection = verdict.claim.own,
                   .cases = {judged_case(6.44, "f64", false), judged_case(0.000001943, "f32", true),
                             judged_case(17.2, "f64", true)},
                   .held = 2,
                   .n = 3};
    verdict.others = {
        {.selection = verdict.claim.others[0], .cases = {judged_case(0.5, "f64", false)}, .held = 0, .n = 1}};
    return verdict;
}

std::string measured(const std::string& headline)
{
    return measured_text(verdict_with(headline));
}

TEST(Headline, IsFilledFromTheFactsOfTheVerdict)
{
    EXPECT_EQ(measured("in {held} of {n} poses"), "in 2 of 3 poses");
    EXPECT_EQ(measured("{least} to {most} {unit}"), "1.9e-6 to 17 %");
    EXPECT_EQ(measured("{least at precision=f64} to {most_pct}"), "6.4 to 1720");
    EXPECT_EQ(measured("{held of wrong weights} of {n of wrong weights}; {most of wrong weights}"), "0 of 1; 0.5");
    EXPECT_EQ(measured("nothing in print"), "nothing in print");
}

TEST(Headline, StatesTheSignOfACensoredNumberAndSkipsCasesThatDoNotCount)
{
    Verdict verdict = verdict_with("{least} to {most}");
    verdict.own.cases[2] = judged_case(1000.0, "f64", false);
    verdict.own.cases[2].limit = Limit::more_than;
    verdict.own.cases[1].excluded = Excluded::no_control;
    EXPECT_EQ(measured_text(verdict), "6.4 to > 1000");
    verdict.own.cases[0].value = std::nan("");
    EXPECT_EQ(measured_text(verdict), "> 1000 to > 1000");
}

TEST(Headline, IsEmptyWhereANumberIsNotKnown)
{
    EXPECT_EQ(measured("{most at precision=f16}"), "");
    Verdict verdict = verdict_with("in {held} of {n}");
    verdict.own = {.selection = verdict.claim.own};
    EXPECT_EQ(measured_text(verdict), "");
    verdict.claim.headline = "{least} {unit}";
    EXPECT_EQ(measured_text(verdict), "");
}

TEST(Headline, CountsThePrintedValues)
{
    Verdict verdict{.claim = {.headline = "{held} of {n}"}};
    verdict.printed = {{"C14", "edges", {}, 1.0, 0.0, 2.0}, {"C14", "edges", {}, 3.0, 0.0, 2.0}};
    EXPECT_EQ(measured_text(verdict), "1 of 2");
}

TEST(Headline, FaultsAreNamed)
{
    const auto fault = [](const std::string& headline) { return headline_fault(verdict_with(headline).claim); };
    EXPECT_EQ(fault("{held} of {n of wrong weights} {most at precision=f64}"), "");
    EXPECT_EQ(fault("nothing in print"), "");
    EXPECT_EQ(fault(""), "expected 1 to 30 characters besides the placeholders");
    EXPECT_EQ(fault(std::string(31, 'a') + "{n}"), "expected 1 to 30 characters besides the placeholders");
    EXPECT_EQ(fault("{cases}"), "{cases}: expected held, n, least, most, least_pct, most_pct, unit");
    EXPECT_EQ(fault("{held of LBS}"), "{held of LBS}: expected the name of a control or comparison of the claim");
    EXPECT_EQ(fault("{most at bone=1}"), "{most at bone=1}: expected a field of a key");
    EXPECT_EQ(fault("{most at precision}"),
              "{most at precision}: expected held, n, least, most, least_pct, most_pct, unit");
    EXPECT_EQ(fault("29 of {n}"), "expected numbers only as {placeholders}");
    EXPECT_EQ(fault("{held of {n}"), "{held of {n}: expected the name of a control or comparison of the claim");
    for (const char* text : {"in {held", "in held}", "{}"})
        EXPECT_EQ(fault(text), "expected each { with its } and a fact between them") << text;
}

TEST(ShortName, HasAtMostEightWordsAndItsWidth)
{
    const auto fault = [](const std::string& text) { return short_name_fault({.short_name = text}); };
    const std::string rule = "expected 1 to 8 words of at most 32 characters in all";
    EXPECT_EQ(fault("1 2 3 4 5 6 7 8"), "");
    for (const std::string& text :
         {std::string(), std::string("  "), std::string("1 2 3 4 5 6 7 8 9"), std::string(33, 'a')})
        EXPECT_EQ(fault(text), rule) << text;
}

TEST(Threshold, IsPutIntoWords)
{
    constexpr double none = std::numeric_limits<double>::infinity();
    const auto text = [](double low, double high) { return threshold_text({.low = low, .high = high}); };
    EXPECT_EQ(text(0.9, 1.1), "0.9 to 1.1");
    EXPECT_EQ(text(30.0, none), "30 or more");
    EXPECT_EQ(text(-none, 1.05), "1.05 or less");
    EXPECT_EQ(text(-none, 1e-12), "1e-12 or less");
    EXPECT_EQ(text(0.0, 0.0), "0");
    EXPECT_EQ(text(-none, std::nextafter(1.0, 0.0)), "below 1");
    EXPECT_EQ(text(1e-9, none), "above 0");
    EXPECT_EQ(text(-none, none), "");
}

TEST(Asked, IsTheThresholdOfTheNumbersThatTheHeadlineStates)
{
    const auto asked = [](const std::string& headline, const Threshold& threshold, ClaimRule rule = ClaimRule::cases) {
        Claim claim = verdict_with(headline).claim;
        claim.rule = rule;
        claim.own.thresholds = {threshold};
        return asked_text(claim);
    };
    EXPECT_EQ(asked("in {held} of {n}", {.low = 0.3}), "95 %") << "a share of the cases";
    EXPECT_EQ(asked("{held}; {most of wrong weights}", {.low = 0.3}), "95 %") << "a number of a control";
    EXPECT_EQ(asked("{least} to {most}", {.low = 30.0}), "30 or more");
    EXPECT_EQ(asked("{least} to {most} {unit}", {.low = 12.0, .high = 16.0}), "12 to 16 %");
    EXPECT_EQ(asked("{least_pct} to {most_pct} %", {.low = 0.95}), "95 % or more");
    EXPECT_EQ(asked("{least}", {.low = 1e-9}, ClaimRule::single), "above 0");
    EXPECT_EQ(asked("{held} of {n}", {}, ClaimRule::printed), "all");
    Claim untestable{.headline = "nothing in print", .rule = ClaimRule::untestable};
    EXPECT_EQ(asked_text(untestable), "");
    Claim two = verdict_with("{most at precision=f32}").claim;
    two.own.thresholds = {{.high = 1e-12}, {.high = 1e-5}, {.high = 3.0, .quantity = "another"}};
    EXPECT_EQ(asked_text(two), "1e-12 or less, 1e-05 or less");
}

}  // namespace

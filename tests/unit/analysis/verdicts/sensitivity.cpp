// Reference: the rule, with counts and numbers chosen by hand.
#include "analysis/verdicts/sensitivity.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace analysis;

// A radius of at least 0.9, where LBS must fail: chance has q = 1 / (n + 2) of a control that holds nowhere.
Claim radius_claim()
{
    Claim claim{.id = "X01"};
    claim.case_fields = {"body", "joint"};
    claim.own = {.name = "X01", .quantities = {"radius"}, .of = {.deformer = "pbs"}, .thresholds = {{.low = 0.9}}};
    claim.others = {claim.own};
    claim.others[0].name = "LBS";
    claim.others[0].role = Role::negative_control;
    claim.others[0].of.deformer = "lbs";
    return claim;
}

void add(Records& records, const std::string& body, int joint, double of_pbs, double of_lbs)
{
    for (const auto& [deformer, value] : {std::pair{"pbs", of_pbs}, {"lbs", of_lbs}}) {
        const CaseKey key = {.body = body, .joint = std::to_string(joint), .deformer = deformer};
        records.measurements.push_back(
            {.quantity = "radius", .of = key, .value = value, .low = value, .high = value, .unit = "1"});
    }
}

// Ten joints of one body hold by 0.95 to 1.04, and ten of another body at 1; LBS has 0.2 to 0.4.
Records two_bodies()
{
    Records records;
    for (int joint = 0; joint < 10; ++joint) {
        add(records, "arm", joint, 0.95 + 0.01 * joint, 0.2);
        add(records, "leg", joint, 1.0, 0.4);
    }
    return records;
}

TEST(Sensitivity, JudgesWithoutEachBody)
{
    Records records = two_bodies();
    for (int joint = 10; joint < 14; ++joint) add(records, "hand", joint, 0.1, 0.2);  // 20 of 24 hold
    const Sensitivity found = sensitivity(radius_claim(), records);
    ASSERT_EQ(found.without_body.size(), 3u);
    EXPECT_EQ(judge(radius_claim(), records).kind, VerdictKind::mixed);
    EXPECT_EQ(found.without_body[0].body, "arm");
    EXPECT_EQ(found.without_body[0].kind, VerdictKind::mixed) << "10 of 14";
    EXPECT_EQ(found.without_body[1].body, "hand");
    EXPECT_EQ(found.without_body[1].kind, VerdictKind::holds) << "20 of 20";
}

TEST(Sensitivity, ExcludesABodyFromTheControlsTooUnlessItIsTheirOnlyOne)
{
    Records records = two_bodies();
    for (Measurement& one : records.measurements)
        if (one.of.deformer == "lbs" && one.of.body == "leg") one.value = one.low = one.high = 1.0;
    const Sensitivity both = sensitivity(radius_claim(), records);
    EXPECT_EQ(judge(radius_claim(), records).kind, VerdictKind::holds) << "LBS fails in half of its cases";
    EXPECT_EQ(both.without_body[0].kind, VerdictKind::inconclusive) << "without the arm it fails nowhere";
    std::erase_if(records.measurements,
                  [](const Measurement& one) { return one.of.deformer == "lbs" && one.of.body == "leg"; });
    EXPECT_EQ(sensitivity(radius_claim(), records).without_body[0].kind, VerdictKind::holds) << "only the arm has LBS";
}

// 19 of 20 must hold: the second least number of PBS is 0.96. Half of LBS's 0.4 and 0.2 must fail: above 0.2.
TEST(Sensitivity, GivesTheRangeOfALowThresholdOverWhichTheVerdictStands)
{
    const Records records = two_bodies();
    const Sensitivity found = sensitivity(radius_claim(), records);
    ASSERT_EQ(found.ranges.size(), 1u);
    const ThresholdRange& range = found.ranges[0];
    EXPECT_FALSE(range.is_high);
    EXPECT_EQ(range.high, 0.96);
    EXPECT_EQ(range.low, 0.2);
    const auto kind_at = [&](double low) {
        Claim claim = radius_claim();
        for (Selection* of : {&claim.own, &claim.others[0]}) of->thresholds = {{.low = low}};
        return judge(claim, records).kind;
    };
    EXPECT_EQ(kind_at(range.high), VerdictKind::holds);
    EXPECT_EQ(kind_at(std::nextafter(range.high, 2.0)), VerdictKind::mixed);
    EXPECT_EQ(kind_at(std::nextafter(range.low, 2.0)), VerdictKind::holds);
    EXPECT_EQ(kind_at(range.low), VerdictKind::inconclusive);
}

// The mirror image: radii below 1.1, of which 19 of 20 must hold, and LBS at 1.6 and 1.8.
TEST(Sensitivity, GivesTheRangeOfAHighThreshold)
{
    Claim claim = radius_claim();
    for (Selection* of : {&claim.own, &claim.others[0]}) of->thresholds = {{.high = 1.1}};
    Records records = two_bodies();
    for (Measurement& one : records.measurements) one.value = one.low = one.high = 2.0 - one.value;
    const Sensitivity found = sensitivity(claim, records);
    ASSERT_EQ(found.ranges.size(), 1u);
    EXPECT_TRUE(found.ranges[0].is_high);
    EXPECT_EQ(found.ranges[0].low, 2.0 - 0.96);
    EXPECT_EQ(found.ranges[0].high, 2.0 - 0.2);
}

TEST(Sensitivity, AThresholdThatNoNumberReachesIsOpen)
{
    Claim claim = radius_claim();
    claim.no_effect = 0.5;
    claim.others.clear();
    const Sensitivity found = sensitivity(claim, two_bodies());
    EXPECT_EQ(found.ranges[0].low, -std::numeric_limits<double>::infinity());
    EXPECT_EQ(found.ranges[0].high, 0.96);
}

TEST(Sensitivity, HasEachEndOfEachThreshold)
{
    Claim claim = radius_claim();
    claim.own.thresholds = {{.low = 0.5, .high = 2.0}, {.high = 3.0, .quantity = "area"}};
    EXPECT_EQ(sensitivity(claim, two_bodies()).ranges.size(), 3u);
}

TEST(Sensitivity, IsEmptyForOtherRulesAndWithoutRecords)
{
    Claim claim = radius_claim();
    claim.rule = ClaimRule::single;
    EXPECT_TRUE(sensitivity(claim, two_bodies()).ranges.empty());
    Records records = two_bodies();
    records.missing_runs = {"a/run"};
    EXPECT_TRUE(sensitivity(radius_claim(), records).without_body.empty());
    const Sensitivity none = sensitivity(radius_claim(), {});
    EXPECT_TRUE(none.without_body.empty());
    EXPECT_EQ(none.ranges.at(0).high, std::numeric_limits<double>::infinity()) << "it stays inconclusive";
}

TEST(Sensitivity, DoesNotDependOnHeldOutValues)
{
    Claim claim = radius_claim();
    claim.held_out = {{.motion = "later"}};
    Records records = two_bodies();
    for (int joint = 0; joint < 20; ++joint) {
        add(records, "foot", joint, 0.1, 1.0);
        for (std::size_t i = records.measurements.size() - 2; i < records.measurements.size(); ++i)
            records.measurements[i].of.motion = "later";
    }
    const Sensitivity found = sensitivity(claim, records);
    EXPECT_EQ(found.without_body.size(), 2u);
    EXPECT_EQ(found.ranges[0].high, 0.96);
}

}  // namespace

// Reference: the rule, with counts and numbers chosen by hand. tests/claims/recomputed.py computes the ranges of all
// thresholds on the kept records a second time.
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

TEST(Sensitivity, AThresholdThatNoNumberReachesIsOpen)
{
    Claim claim = radius_claim();
    claim.no_effect = 0.5;
    claim.others.clear();
    const Sensitivity found = sensitivity(claim, two_bodies());
    EXPECT_EQ(found.ranges[0].low, -std::numeric_limits<double>::infinity());
    EXPECT_EQ(found.ranges[0].high, 0.96);
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

}  // namespace

#include "analysis/verdicts/measurement.hpp"

#include "analysis/records/record_files.hpp"
#include "analysis/verdicts/verdict.hpp"
#include "pbs/geometry/input_error.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace analysis;

Claim drift_claim()
{
    Claim claim;
    claim.id = "C07";
    claim.rule = ClaimRule::measured;
    claim.metrics = {"linear_drift", "angular_drift"};
    claim.low = 0.0;
    claim.high = 1e-3;
    return claim;
}

Measurement drift_of(const CaseKey& of, double value)
{
    return {"C07", "linear_drift", of, value, value, value, "1"};
}

Measurement drift(const std::string& body, double value)
{
    return drift_of({.body = body}, value);
}

TEST(Measurement, ComesBackFromItsTable)
{
    const test_support::ScratchFolder folder;
    const std::string path = folder / "measurements.csv";
    const CaseKey key = {.body = "limb \"soft\", thin", .motion = "bend", .angle_deg = 1.0 / 3.0, .deformer = "pbs", .iterations = 24.0};
    const Measurement written{"C07", "linear_drift", key, 1.0 / 3.0, 0.25, 0.5, "m", "", Limit::more_than, 4, 1};
    measurement_table({written, drift("human", 1e-300)}).write(path);
    const auto read = measurements(path);
    ASSERT_EQ(read.size(), 2u);
    EXPECT_EQ(read[0].quantity, written.quantity);
    EXPECT_EQ(read[0].of, written.of);
    EXPECT_EQ(read[0].limit, Limit::more_than);
    EXPECT_EQ(read[0].n, 4);
    EXPECT_EQ(read[0].not_reached, 1);
    EXPECT_EQ(read[1].of, CaseKey{.body = "human"});
    EXPECT_EQ(read[1].limit, Limit::none);
    EXPECT_EQ(read[0].value, written.value);
    EXPECT_EQ(read[0].high, written.high);
    EXPECT_EQ(read[1].value, 1e-300);
    write_text_atomically(path, "claim,quantity,value,low,high,unit,limit\nC07,linear_drift,1,1,1,1,roughly\n");
    EXPECT_THROW(measurements(path), pbs::InputError) << "an unknown limit";
}

TEST(Measurement, HoldsWholeInPartOrNotWhereAQuantityMayHaveABoundOfItsOwn)
{
    Measurement measured = drift("limb", 5e-4);
    EXPECT_EQ(extent_of(drift_claim(), measured), Extent::whole);
    measured.high = 2e-3;
    EXPECT_EQ(extent_of(drift_claim(), measured), Extent::part);
    EXPECT_EQ(extent_of(drift_claim(), drift("limb", 2e-3)), Extent::none);
    EXPECT_EQ(extent_of(drift_claim(), drift("limb", std::nan(""))), Extent::none);
    Claim claim = drift_claim();
    claim.bounds = {{"angular_drift", 0.5, 2.0}};
    EXPECT_EQ(bound_of(claim, "linear_drift").high, 1e-3);
    EXPECT_EQ(extent_of(claim, {"C07", "angular_drift", {}, 1.0, 0.5, 2.0, "1"}), Extent::whole);
    EXPECT_EQ(extent_of(claim, {"C07", "angular_drift", {}, 1e-4, 1e-4, 1e-4, "1"}), Extent::none);
    EXPECT_EQ(bound_text({"", 0.0, 0.0}), "0");
    EXPECT_EQ(bound_text({"", 30.0, 1e9}), "30 or more");
    EXPECT_EQ(bound_text({"", 0.9, 1.1}), "0.9 to 1.1");
}

TEST(Measurement, AlteredRecordsFlipTheVerdictAndWithoutAPlannedRunNothingIsJudged)
{
    Records records;
    records.measurements = {drift("limb", 1e-6), drift("human", 1e-5), {"C99", "linear_drift", {.body = "another"}, 9.0, 9.0, 9.0, "1"}};
    EXPECT_EQ(judge(drift_claim(), records).kind, VerdictKind::reproduced);
    records.measurements[1].value = 0.5;
    const Verdict in_part = judge(drift_claim(), records);
    EXPECT_EQ(in_part.kind, VerdictKind::reproduced_only_for);
    ASSERT_EQ(in_part.subjects.size(), 2u);
    EXPECT_EQ(in_part.subjects[0].name, "human");
    EXPECT_EQ(in_part.subjects[0].extent, Extent::none);
    EXPECT_EQ(in_part.subjects[1].extent, Extent::whole);
    ASSERT_TRUE(in_part.primary);
    EXPECT_EQ(in_part.primary->of.body, "human");
    EXPECT_EQ(in_part.primary->value, 0.5);
    EXPECT_EQ(in_part.primary->bound_high, 1e-3);
    records.measurements[0].value = 0.5;
    EXPECT_EQ(judge(drift_claim(), records).kind, VerdictKind::not_reproduced);
    records.measurements.clear();
    EXPECT_EQ(judge(drift_claim(), records).kind, VerdictKind::not_computable);
    records.left_out = {{"human", "not installed"}};
    EXPECT_EQ(judge(drift_claim(), records).kind, VerdictKind::cannot_be_tested_here);
    const Verdict without_a_run = judge(drift_claim(), {.measurements = {drift("limb", 1e-6)}, .missing_runs = {"human"}});
    EXPECT_EQ(without_a_run.kind, VerdictKind::not_computable);
    EXPECT_EQ(without_a_run.missing, std::vector<std::string>{"human"});
}

TEST(Measurement, AVerdictCountsValuesBySubject)
{
    Records records;
    records.measurements = {drift_of({.body = "limb", .pose = "bent"}, 1e-6), drift_of({.body = "limb", .pose = "straight"}, 0.25),
                            drift("human", 1e-5), drift("bar", std::nan(""))};
    Claim claim = drift_claim();
    const Verdict verdict = judge(claim, records);
    std::vector<std::string> names;
    for (const auto& subject : verdict.subjects) names.push_back(subject.name);
    EXPECT_EQ(names, (std::vector<std::string>{"bar", "human", "limb"}));
    EXPECT_EQ(verdict.subjects[2].within, 1);
    EXPECT_EQ(verdict.subjects[2].all, 2);
    EXPECT_EQ(verdict.subjects[2].extent, Extent::part);
    EXPECT_EQ(verdict.primary->of.body, "bar");  // a value that is not a number is farthest outside
    claim.subject = "pose";
    EXPECT_EQ(judge(claim, records).subjects.size(), 3u);  // bent, straight, none
}

TEST(Measurement, WhatIsReportedAndOtherKeysOfTheSameQuantityAreControls)
{
    Claim claim = drift_claim();
    claim.reported = {"energy"};
    claim.of = {.deformer = "pbs"};
    const CaseKey pbs = {.body = "limb", .deformer = "pbs"}, lbs = {.body = "limb", .deformer = "lbs"};
    const Verdict verdict =
        judge(claim, {.measurements = {drift_of(pbs, 1e-6), drift_of(lbs, 0.5), {"C07", "energy", pbs, 9.0, 9.0, 9.0, "J"}}});
    EXPECT_EQ(verdict.kind, VerdictKind::reproduced);
    EXPECT_EQ(verdict.n, 1);
    ASSERT_EQ(verdict.controls.size(), 2u);
    EXPECT_EQ(verdict.controls[0].of.deformer, "lbs");
    EXPECT_EQ(verdict.controls[1].quantity, "energy");
}

TEST(Measurement, ASubjectHoldsForEachValueOfAFieldThatIsCountedApart)
{
    Claim claim = drift_claim();
    const Records records{
        .measurements = {drift_of({.body = "limb", .deformer = "pbs"}, 1e-6), drift_of({.body = "limb", .deformer = "lbs"}, 0.5)}};
    EXPECT_EQ(judge(claim, records).kind, VerdictKind::reproduced_only_for);
    claim.each = {"deformer"};
    EXPECT_EQ(judge(claim, records).kind, VerdictKind::not_reproduced);
}

TEST(Measurement, ThePrimaryValueIsTheOneNearestToItsBoundOrFarthestOutside)
{
    Measurement leaves = drift("limb", 5e-4);
    leaves.high = 2e-3;
    const double infinity = std::numeric_limits<double>::infinity();
    const std::vector<Measurement> open = {drift("limb", 93.5), drift("human", 206.0)};
    struct Case {
        const char* name;
        double low, high;
        std::vector<Measurement> values;
        std::string primary;
    };
    const std::vector<Case> all = {
        {"all hold", 0.0, 1e-3, {drift("limb", 1e-6), drift("human", 9e-4), drift("man", 1e-5)}, "human"},
        {"an interval leaves the bound", 0.0, 1e-3, {drift("human", 9e-4), leaves}, "limb"},
        {"a value is outside", 0.0, 1e-3, {drift("human", 9e-4), leaves, drift("man", 1.5e-3)}, "man"},
        {"an open end does not choose", 30.0, open_end, open, "limb"},
        {"no finite value, so it is outside", 30.0, open_end, {open[0], open[1], drift("man", infinity)}, "man"},
        {"and farther than a finite one", 30.0, open_end, {open[0], open[1], drift("man", infinity), drift("bar", 3.0)}, "man"},
    };
    for (const Case& of : all) {
        Claim claim = drift_claim();
        claim.low = of.low;
        claim.high = of.high;
        EXPECT_EQ(judge(claim, {.measurements = of.values}).primary->of.body, of.primary) << of.name;
    }
}

TEST(Measurement, AClaimOfSeveralQuantitiesAsksForAllOfThem)
{
    const auto angular = [](const CaseKey& of, double value) { return Measurement{"C07", "angular_drift", of, value, value, value, "1"}; };
    const CaseKey bent = {.body = "limb", .pose = "bent"}, straight = {.body = "limb", .pose = "straight"};
    Records records;
    records.measurements = {drift_of(bent, 1e-6), drift_of(straight, 1e-6), angular(bent, 0.5), angular(straight, 0.5)};
    EXPECT_EQ(judge(drift_claim(), records).kind, VerdictKind::not_reproduced);
    records.measurements[3].value = records.measurements[3].low = records.measurements[3].high = 1e-6;
    EXPECT_EQ(judge(drift_claim(), records).kind, VerdictKind::reproduced_only_for);
}

}  // namespace

#include "analysis/measurement.hpp"

#include "analysis/verdict.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using analysis::Extent;
using analysis::Measurement;
using analysis::VerdictKind;

analysis::Claim drift_claim()
{
    analysis::Claim claim;
    claim.id = "C07";
    claim.rule = analysis::ClaimRule::measured;
    claim.metrics = {"linear drift", "angular drift"};
    claim.low = 0.0;
    claim.high = 1e-3;
    return claim;
}

Measurement drift(const std::string& of, double value)
{
    return {"C07", "linear drift", of, value, value, value, "1"};
}

TEST(Measurement, ComesBackFromItsTable)
{
    const test_support::ScratchFolder folder;
    const std::string path = folder / "measurements.csv";
    const Measurement written{"C07", "linear, drift", "limb \"bent\"", 1.0 / 3.0, 0.25, 0.5, "m"};
    analysis::measurement_table({written, drift("human", 1e-300)}).write(path);
    const auto read = analysis::measurements(path);
    ASSERT_EQ(read.size(), 2u);
    EXPECT_EQ(read[0].quantity, written.quantity);
    EXPECT_EQ(read[0].of, written.of);
    EXPECT_EQ(read[0].value, written.value);
    EXPECT_EQ(read[0].high, written.high);
    EXPECT_EQ(read[1].value, 1e-300);
}

TEST(Measurement, HoldsWholeInPartOrNot)
{
    Measurement measured = drift("limb", 5e-4);
    EXPECT_EQ(analysis::extent_of(drift_claim(), measured), Extent::whole);
    measured.high = 2e-3;
    EXPECT_EQ(analysis::extent_of(drift_claim(), measured), Extent::part);
    EXPECT_EQ(analysis::extent_of(drift_claim(), drift("limb", 2e-3)), Extent::none);
    EXPECT_EQ(analysis::extent_of(drift_claim(), drift("limb", std::nan(""))), Extent::none);
}

TEST(Measurement, AlteredRecordsFlipTheVerdict)
{
    analysis::Records records;
    records.measurements = {drift("limb", 1e-6), drift("human", 1e-5), {"C99", "linear drift", "another's", 9.0, 9.0, 9.0, "1"}};
    EXPECT_EQ(judge(drift_claim(), records).kind, VerdictKind::reproduced);
    records.measurements[1].value = 0.5;
    const analysis::Verdict in_part = judge(drift_claim(), records);
    EXPECT_EQ(in_part.kind, VerdictKind::reproduced_only_for);
    EXPECT_EQ(in_part.text, "reproduced only for limb; not for human; farthest: linear drift of human is 0.5");
    records.measurements[0].value = 0.5;
    EXPECT_EQ(judge(drift_claim(), records).kind, VerdictKind::not_reproduced);
    records.measurements.clear();
    EXPECT_EQ(judge(drift_claim(), records).kind, VerdictKind::not_computable);
    records.left_out = {{"human", "not installed"}};
    EXPECT_EQ(judge(drift_claim(), records).kind, VerdictKind::cannot_be_tested_here);
}

TEST(Measurement, AQuantityMayHaveABoundOfItsOwn)
{
    analysis::Claim claim = drift_claim();
    claim.bounds = {{"angular drift", 0.5, 2.0}};
    EXPECT_EQ(analysis::bound_of(claim, "linear drift").high, 1e-3);
    EXPECT_EQ(analysis::extent_of(claim, {"C07", "angular drift", "limb", 1.0, 0.5, 2.0, "1"}), Extent::whole);
    EXPECT_EQ(analysis::extent_of(claim, {"C07", "angular drift", "limb", 1e-4, 1e-4, 1e-4, "1"}), Extent::none);
    EXPECT_EQ(analysis::bound_text({"", 0.0, 0.0}), "0");
    EXPECT_EQ(analysis::bound_text({"", 30.0, 1e9}), "30 or more");
    EXPECT_EQ(analysis::bound_text({"", 0.9, 1.1}), "0.9 to 1.1");
}

TEST(Measurement, WhatStandsBesideIsNoPartOfTheVerdict)
{
    analysis::Claim claim = drift_claim();
    claim.beside = {"energy"};
    analysis::Records records;
    records.measurements = {drift("limb", 1e-6), {"C07", "energy", "limb", 9.0, 9.0, 9.0, "J"}};
    const analysis::Verdict verdict = judge(claim, records);
    EXPECT_EQ(verdict.kind, VerdictKind::reproduced);
    ASSERT_EQ(verdict.measured_beside.size(), 1u);
    EXPECT_EQ(verdict.measured_beside[0].quantity, "energy");
}

TEST(Measurement, AVerdictCountsFiguresBySubject)
{
    analysis::Records records;
    records.measurements = {drift("limb, bent", 1e-6), drift("limb, straight", 0.25), drift("human, crouch", 1e-5),
                            drift("bar", std::nan(""))};
    EXPECT_EQ(judge(drift_claim(), records).text,
              "reproduced only for human, limb (1 of 2 figures); not for bar; farthest: linear drift of bar is nan");
}

TEST(Measurement, AClaimOfSeveralQuantitiesAsksForAllOfThem)
{
    const auto angular = [](const std::string& of, double value) {
        return Measurement{"C07", "angular drift", of, value, value, value, "1"};
    };
    analysis::Records records;
    records.measurements = {drift("limb, bent", 1e-6), drift("limb, straight", 1e-6), angular("limb, bent", 0.5),
                            angular("limb, straight", 0.5)};
    EXPECT_EQ(judge(drift_claim(), records).kind, VerdictKind::not_reproduced);
    records.measurements[3].value = records.measurements[3].low = records.measurements[3].high = 1e-6;
    EXPECT_EQ(judge(drift_claim(), records).kind, VerdictKind::reproduced_only_for);
}

TEST(Measurement, WithoutAPlannedRunNothingIsJudged)
{
    analysis::Records records;
    records.measurements = {drift("limb", 1e-6)};
    records.missing_runs = {"human"};
    const analysis::Verdict verdict = judge(drift_claim(), records);
    EXPECT_EQ(verdict.kind, VerdictKind::not_computable);
    EXPECT_EQ(verdict.text, "not computable: no record of human");
}

TEST(Measurement, WhatHoldsIsToldWithWhatStandsBesideIt)
{
    analysis::Claim claim = drift_claim();
    claim.beside = {"energy"};
    analysis::Records records;
    records.measurements = {
        drift("limb", 1e-6), {"C07", "energy", "limb", 9.0, 9.0, 9.0, "J"}, {"C07", "energy", "limb", 2.0, 2.0, 2.0, "J"}};
    EXPECT_EQ(judge(claim, records).text, "reproduced: limb; beside it: energy 2 J to 9 J");
}

}  // namespace

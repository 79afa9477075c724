// Verdicts are computed: each kind follows from its records and changes when they are altered. Reference: the rules in
// experiments/verdicts/claims.toml.
#include "analysis/verdicts/verdict.hpp"

#include "analysis/records/record_files.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace {

using namespace analysis;

Claim claim_of(const std::string& id)
{
    const auto claims = parse_claims(read_text(PBS_CLAIMS_FILE), "claims.toml");
    return *std::find_if(claims.begin(), claims.end(), [&](const Claim& claim) { return claim.id == id; });
}

// The given signed changes; the absolute ones are twice as large and positive, and no tet is inverted.
CaseRecord clip(const std::string& scene, const std::string& deformer, int iterations, const std::vector<double>& change_pct)
{
    CaseRecord record;
    record.scene = scene;
    record.deformer = deformer;
    record.iterations = iterations;
    record.run = "volume/" + scene;
    for (std::size_t i = 0; i < change_pct.size(); ++i) {
        record.frame.push_back(static_cast<double>(i));
        record.time_s.push_back(0.01 * static_cast<double>(i));
        record.volume_change_pct.push_back(change_pct[i]);
        record.volume_abs_change_pct.push_back(2.0 * std::abs(change_pct[i]));
        record.inverted_tets.push_back(0.0);
    }
    return record;
}

void set_change(CaseRecord& record, int frame, double change_pct)
{
    record.volume_change_pct[frame] = change_pct;
    record.volume_abs_change_pct[frame] = 2.0 * std::abs(change_pct);
}

// 10 deg per frame.
CaseRecord sweep(const std::string& scene, const std::string& deformer, int iterations, const std::vector<double>& change_pct)
{
    CaseRecord record = clip(scene, deformer, iterations, change_pct);
    for (double frame : record.frame) record.angle_deg.push_back(10.0 * frame);
    return record;
}

std::vector<double> constant(int frames, double value)
{
    return std::vector<double>(static_cast<std::size_t>(frames), value);
}

VerdictKind kind_for(const std::string& id, const std::vector<CaseRecord>& cases)
{
    return judge(claim_of(id), {.cases = cases}).kind;
}

TEST(VolumeIsPreserved, ReproducedWhereEveryCaseHolds)
{
    const auto walk = clip("walk", "pbs", 24, constant(100, -0.3));
    const auto twist = sweep("twist", "pbs", 24, constant(18, -0.5));  // a value on the bound is within
    const Verdict verdict = judge(claim_of("C02"), {.cases = {walk, twist}});
    EXPECT_EQ(verdict.kind, VerdictKind::reproduced);
    EXPECT_EQ(verdict.runs, (std::vector<std::string>{"volume/twist", "volume/walk"}));
    EXPECT_EQ(verdict.interval.estimate, 1.0);
    ASSERT_TRUE(verdict.primary);
    EXPECT_EQ(verdict.primary->statistic, "share_of_frames");
    EXPECT_EQ(verdict.primary->of.body, "walk");
    EXPECT_EQ(verdict.primary->bound_low, 0.95);
    EXPECT_EQ(verdict.within, 2);
    EXPECT_EQ(verdict.n, 2);
    EXPECT_EQ(verdict.cases.size(), 4u);  // two cases with two metrics
}

TEST(VolumeIsPreserved, FlipsWhenFramesOfAClipFail)
{
    auto walk = clip("walk", "pbs", 24, constant(100, -0.3));
    EXPECT_EQ(kind_for("C02", {walk}), VerdictKind::reproduced);
    for (int i = 20; i < 30; ++i) set_change(walk, i, -0.51);  // 90 % hold
    EXPECT_EQ(kind_for("C02", {walk}), VerdictKind::not_reproduced);
    EXPECT_EQ(kind_for("C02", {walk, sweep("twist", "pbs", 24, constant(9, 0.1))}), VerdictKind::reproduced_only_for);
}

TEST(VolumeIsPreserved, GainCountsLikeLoss)
{
    EXPECT_EQ(kind_for("C02", {clip("walk", "pbs", 24, constant(30, 0.6))}), VerdictKind::not_reproduced);
}

TEST(VolumeIsPreserved, ShareAboveTheBoundWithAnIntervalBelowItDoesNotHold)
{
    auto walk = clip("walk", "pbs", 24, constant(100, 0.0));
    for (int i = 40; i < 43; ++i) set_change(walk, i, -2.0);  // 97 % hold, and the failures are consecutive
    const Verdict verdict = judge(claim_of("C02"), {.cases = {walk}});
    EXPECT_NEAR(verdict.interval.estimate, 0.97, test_support::mean_error(100, 0.97));
    EXPECT_LT(verdict.interval.low, 0.95);
    EXPECT_EQ(verdict.kind, VerdictKind::not_reproduced);
}

TEST(VolumeIsPreserved, TheClipWithTheLowestShareRepresentsTheClaimInAnyVariant)
{
    CaseRecord walk = clip("walk", "pbs", 24, constant(100, -0.6)), jiggling = clip("jump", "pbs", 24, constant(100, -0.6));
    jiggling.variant = "jiggle";
    set_change(walk, 3, 0.0);
    EXPECT_EQ(judge(claim_of("C02"), {.cases = {walk, jiggling}}).primary->of.body, "jump");
    set_change(jiggling, 3, 0.0);
    set_change(jiggling, 60, 0.0);
    EXPECT_EQ(judge(claim_of("C02"), {.cases = {walk, jiggling}}).primary->of.body, "walk");
}

TEST(VolumeIsPreserved, SweepHoldsUpToItsFirstFailure)
{
    auto twist = sweep("twist", "pbs", 24, {0, -0.1, -0.2, -0.3, -0.6, -0.4, -0.9});
    const Verdict verdict = judge(claim_of("C02"), {.cases = {twist}});
    EXPECT_EQ(verdict.kind, VerdictKind::reproduced_only_for);
    ASSERT_EQ(verdict.cases[0].angles.size(), 1u);
    EXPECT_EQ(verdict.cases[0].angles[0].to_deg, 30.0);
    EXPECT_EQ(verdict.cases[0].deepest.size(), 2u);
    EXPECT_EQ(verdict.cases[0].deepest[0].angle_deg, 60.0);
    EXPECT_EQ(verdict.cases[0].deepest[0].value, -0.9);
    EXPECT_EQ(verdict.cases[0].last_angle_deg, 60.0);
    EXPECT_EQ(verdict.cases[0].extent, Extent::part);
    EXPECT_EQ(verdict.cases[1].metric, "volume_abs_change_pct");
    EXPECT_EQ(verdict.cases[1].angles.at(0).to_deg, 20.0);
    EXPECT_FALSE(verdict.primary);  // only sweeps

    set_change(twist, 4, -0.5);
    EXPECT_EQ(judge(claim_of("C02"), {.cases = {twist}}).cases[0].angles[0].to_deg, 50.0);
    set_change(twist, 6, -0.5);
    EXPECT_EQ(kind_for("C02", {twist}), VerdictKind::reproduced);
    set_change(twist, 1, -0.7);  // a claim that holds in the rest pose alone holds nowhere
    EXPECT_EQ(kind_for("C02", {twist}), VerdictKind::not_reproduced);
}

TEST(VolumeIsPreserved, HoldingNearTheRestPoseAloneIsNotEnough)
{
    auto twist = sweep("twist", "pbs", 24, constant(21, -2.0));
    for (int i = 0; i <= 4; ++i) set_change(twist, i, 0.0);  // up to 40 of 200 deg: less than one quarter
    EXPECT_EQ(kind_for("C02", {twist}), VerdictKind::not_reproduced);
    set_change(twist, 5, 0.0);
    EXPECT_EQ(kind_for("C02", {twist}), VerdictKind::reproduced_only_for);
}

TEST(LossOfLbs, AMeanWhoseIntervalLeavesTheBandDoesNotHold)
{
    std::vector<double> loss;
    for (int i = 0; i < 100; ++i) loss.push_back(-12.1 + (i % 2 == 0 ? 3.0 : -3.0));
    EXPECT_NE(kind_for("C01", {clip("walk", "lbs", 0, loss)}), VerdictKind::reproduced);
    EXPECT_EQ(kind_for("C01", {clip("walk", "lbs", 0, constant(100, -14.0))}), VerdictKind::reproduced);
}

TEST(VolumeIsPreserved, RestPoseAloneIsNoSweep)
{
    const Verdict verdict = judge(claim_of("C02"), {.cases = {sweep("twist", "pbs", 24, {0.0})}});
    EXPECT_EQ(verdict.kind, VerdictKind::not_reproduced);
    EXPECT_EQ(verdict.within, 0);
    for (const CaseJudgement& judged : verdict.cases) EXPECT_EQ(judged.extent, Extent::none) << judged.metric;
}

TEST(VolumeIsPreserved, InvertedTetsInFramesThatHoldAreTold)
{
    auto bend = sweep("bend", "pbs", 24, constant(10, -0.2));
    bend.inverted_tets[7] = bend.inverted_tets[9] = 15.0;
    const Verdict verdict = judge(claim_of("C02"), {.cases = {bend}});
    EXPECT_EQ(verdict.cases[0].holding_with_inverted_tets, 2);
}

TEST(VolumeIsPreserved, BreakdownDoesNotHold)
{
    auto walk = clip("walk", "pbs", 24, constant(60, -0.3));
    for (int i = 30; i < 60; ++i) set_change(walk, i, std::numeric_limits<double>::quiet_NaN());
    const Verdict verdict = judge(claim_of("C02"), {.cases = {walk}});
    EXPECT_EQ(verdict.kind, VerdictKind::not_reproduced);
    EXPECT_EQ(verdict.cases[0].share.estimate, 0.5);
    EXPECT_EQ(verdict.cases[0].deepest[0].frame, 30.0);
    EXPECT_TRUE(std::isnan(verdict.cases[0].least));
}

TEST(VolumeIsPreserved, OnlyTheAskedDeformerAndIterationsAreJudged)
{
    const auto good = clip("walk", "pbs", 24, constant(100, 0.0)), other = clip("walk", "lbs", 24, constant(30, -9.0)),
               few = clip("walk", "pbs", 4, constant(30, -9.0));
    EXPECT_EQ(kind_for("C02", {good, other, few}), VerdictKind::reproduced);
    EXPECT_EQ(kind_for("C02", {other, few}), VerdictKind::not_computable);
}

TEST(VolumeIsPreserved, OtherDeformersAreComparedAndDecideNothing)
{
    const auto good = clip("walk", "pbs", 24, constant(100, 0.0)), reference = clip("walk", "fem_p2", 0, constant(100, 7.0));
    const Verdict verdict = judge(claim_of("C02"), {.cases = {good, reference}});
    EXPECT_EQ(verdict.kind, VerdictKind::reproduced);
    ASSERT_EQ(verdict.compared.size(), 1u);
    EXPECT_EQ(verdict.compared[0].deformer, "fem_p2");
    EXPECT_EQ(verdict.compared[0].extent, Extent::none);
    EXPECT_NEAR(verdict.compared[0].mean.estimate, 7.0, test_support::mean_error(100, 7.0));
}

TEST(LossOfLbs, ReproducedWhereTheMeansLieInTheBand)
{
    const Verdict verdict = judge(claim_of("C01"), {.cases = {clip("walk", "lbs", 0, {-13, -14, -15, -14, -13, -14})}});
    EXPECT_EQ(verdict.kind, VerdictKind::reproduced);
    EXPECT_NEAR(verdict.interval.estimate, 83.0 / 6.0, test_support::mean_error(6, 83.0 / 6.0));
    ASSERT_TRUE(verdict.primary);
    EXPECT_EQ(verdict.primary->statistic, "mean");
    EXPECT_EQ(verdict.primary->quantity, "volume_loss_pct");
    EXPECT_EQ(verdict.primary->bound_high, 16.0);
    EXPECT_LE(verdict.interval.low, verdict.interval.estimate);
}

TEST(LossOfLbs, FlipsWithTheMean)
{
    auto walk = clip("walk", "lbs", 0, constant(20, -14.0));
    EXPECT_EQ(kind_for("C01", {walk}), VerdictKind::reproduced);
    walk.volume_change_pct = constant(20, -11.9);
    EXPECT_EQ(kind_for("C01", {walk}), VerdictKind::not_reproduced);
    walk.volume_change_pct = constant(20, 14.0);  // a gain
    EXPECT_EQ(kind_for("C01", {walk}), VerdictKind::not_reproduced);
    walk.volume_abs_change_pct = constant(20, 12.5);
    const Verdict verdict = judge(claim_of("C01"), {.cases = {walk}});
    EXPECT_EQ(verdict.kind, VerdictKind::reproduced_only_for);
    EXPECT_EQ(verdict.within, 0);  // by the claim's own metric
    EXPECT_EQ(verdict.cases.at(1).metric, "volume_abs_change_pct");
    EXPECT_EQ(verdict.cases.at(1).extent, Extent::whole);
}

TEST(LossOfLbs, MeanOutsideWithFramesInTheBandIsAPart)
{
    auto walk = clip("walk", "lbs", 0, {-2, -3, -13, -14, -4, -2});
    walk.volume_abs_change_pct = constant(6, 1.0);
    const Verdict verdict = judge(claim_of("C01"), {.cases = {walk}});
    EXPECT_EQ(verdict.kind, VerdictKind::reproduced_only_for);
    EXPECT_EQ(verdict.cases[0].extent, Extent::part);
    EXPECT_NEAR(verdict.cases[0].share.estimate, 1.0 / 3.0, test_support::mean_error(6, 1.0 / 3.0));
}

TEST(LossOfLbs, SweepTellsTheAnglesThatReachTheBand)
{
    auto twist = sweep("twist", "lbs", 0, {0, -4, -9, -13, -15, -17, -14});
    twist.volume_abs_change_pct = constant(7, 1.0);
    const Verdict verdict = judge(claim_of("C01"), {.cases = {twist}});
    EXPECT_EQ(verdict.kind, VerdictKind::reproduced_only_for);
    ASSERT_EQ(verdict.cases[0].angles.size(), 2u);
    EXPECT_EQ(verdict.cases[0].angles[0].from_deg, 30.0);
    EXPECT_EQ(verdict.cases[0].angles[0].to_deg, 40.0);
    EXPECT_EQ(verdict.cases[0].angles[1].from_deg, 60.0);
    EXPECT_EQ(verdict.cases.at(1).extent, Extent::none);
}

TEST(Verdict, MissingRecordsAreNoResult)
{
    EXPECT_EQ(kind_for("C01", {}), VerdictKind::not_computable);
    EXPECT_EQ(kind_for("C01", {clip("walk", "lbs", 0, {})}), VerdictKind::not_computable);
    Records records{.cases = {clip("walk", "lbs", 0, constant(20, -14.0))}, .planned_scenes = {"walk", "twist"}};
    const Verdict verdict = judge(claim_of("C01"), records);
    EXPECT_EQ(verdict.kind, VerdictKind::not_computable);
    EXPECT_EQ(verdict.missing, std::vector<std::string>{"twist"});
    records.left_out = {{"twist", "package missing"}};
    EXPECT_EQ(judge(claim_of("C01"), records).kind, VerdictKind::reproduced);
}

TEST(Verdict, WhatWasLeftOutIsTold)
{
    Records records{.cases = {clip("walk", "lbs", 0, constant(20, -14.0))}, .left_out = {{"man", "man-data is not installed"}}};
    EXPECT_EQ(judge(claim_of("C01"), records).left_out.at(0).reason, "man-data is not installed");
    records.cases.clear();
    const Verdict verdict = judge(claim_of("C01"), records);
    EXPECT_EQ(verdict.kind, VerdictKind::cannot_be_tested_here);
    EXPECT_EQ(verdict.left_out.at(0).scene, "man");
}

TEST(Verdict, ValuesInPrintFlipWithTheirBounds)
{
    Claim claim = claim_of("C01");
    claim.rule = ClaimRule::printed;
    const double infinity = std::numeric_limits<double>::infinity();
    Records records{.printed = {{claim.id, "edges", {.model = "Man"}, 6342, 6653, infinity},
                                {claim.id, "edges", {.model = "Lady"}, 9387, 7862, infinity},
                                {"C00", "another", {}, 1, 2, 3}}};
    const Verdict verdict = judge(claim, records);
    EXPECT_EQ(verdict.kind, VerdictKind::inconsistent_in_print);
    ASSERT_TRUE(verdict.primary);
    EXPECT_EQ(verdict.primary->of.model, "Man");
    EXPECT_EQ(verdict.primary->value, 6342.0);
    EXPECT_EQ(verdict.primary->bound_low, 6653.0);
    EXPECT_EQ(verdict.within, 1);
    EXPECT_EQ(verdict.n, 2);
    records.printed[0].printed = 6653;
    EXPECT_EQ(judge(claim, records).kind, VerdictKind::reproduced);
    EXPECT_EQ(judge(claim, {}).kind, VerdictKind::not_computable);
}

TEST(Verdict, UntestableClaimsSayWhy)
{
    Claim claim = claim_of("C01");
    claim.rule = ClaimRule::untestable;
    claim.reason = "no published figures";
    EXPECT_EQ(judge(claim, {}).kind, VerdictKind::cannot_be_tested_here);
    EXPECT_EQ(judge(claim, {}).claim.reason, "no published figures");
}

CaseRecord in_order(CaseRecord record, const std::string& order, const std::string& precision)
{
    record.deformer = "pbs_orders";
    record.order = order;
    record.precision = precision;
    return record;
}

TEST(OtherOrders, AreJudgedByThemselvesAndAreNoPartOfTheVerdict)
{
    const auto walk = clip("walk", "pbs", 24, constant(100, -0.3));
    const auto other = in_order(clip("walk", "pbs", 24, constant(100, -0.9)), "plain", "f64");
    const Verdict verdict = judge(claim_of("C02"), {.cases = {walk, other}});
    EXPECT_EQ(verdict.kind, VerdictKind::reproduced);
    EXPECT_EQ(verdict.cases.size(), 2u);  // one case with two metrics
    ASSERT_EQ(verdict.orders.size(), 1u);
    EXPECT_EQ(verdict.orders[0].kind, VerdictKind::not_reproduced);
    EXPECT_EQ(verdict.orders[0].own_kind, VerdictKind::reproduced);
    ASSERT_EQ(verdict.orders[0].differing, std::vector<std::size_t>{0});  // the absolute change holds in neither
    EXPECT_EQ(verdict.orders[0].cases[0].metric, "volume_change_pct");
    EXPECT_EQ(verdict.orders[0].cases[0].of.order, "plain");
}

TEST(OtherOrders, FlipWhenTheirRecordsAreAltered)
{
    const auto walk = clip("walk", "pbs", 24, constant(100, -0.3));
    auto plain = in_order(walk, "plain", "f32");
    const auto same = [&] { return judge(claim_of("C02"), {.cases = {walk, plain}}).orders.at(0).same(); };
    EXPECT_TRUE(same());
    for (int i = 20; i < 30; ++i) set_change(plain, i, -0.51);
    EXPECT_FALSE(same());
}

TEST(OtherOrders, AreComparedOnTheScenesTheyWereRecordedOn)
{
    const auto walk = clip("walk", "pbs", 24, constant(100, -0.9));  // fails, and was recorded in only one order
    const auto twist = sweep("twist", "pbs", 24, constant(18, -0.3));
    const Verdict verdict =
        judge(claim_of("C02"), {.cases = {walk, twist, in_order(twist, "grouped", "f32"), in_order(twist, "grouped", "f64")}});
    EXPECT_EQ(verdict.kind, VerdictKind::reproduced_only_for);
    ASSERT_EQ(verdict.orders.size(), 2u);
    EXPECT_EQ(verdict.orders[0].own_kind, VerdictKind::reproduced);
    for (const OrderVerdict& other : verdict.orders) EXPECT_TRUE(other.same()) << other.precision;
}

TEST(OtherOrders, OfOtherIterationsAreNotLookedAt)
{
    const auto walk = clip("walk", "pbs", 24, constant(100, -0.3));
    auto other = in_order(walk, "plain", "f32");
    other.iterations = 12;
    EXPECT_TRUE(judge(claim_of("C02"), {.cases = {walk, other}}).orders.empty());
}

TEST(VolumeIsPreserved, TheSameBodyOnAnotherMeshIsShownAndNotJudged)
{
    const auto walk = clip("walk", "pbs", 24, constant(100, -0.3));
    auto finer = clip("walk_4800", "pbs", 24, constant(100, -3.0));
    finer.beside = true;
    const Verdict verdict = judge(claim_of("C02"), {.cases = {walk, finer}});
    EXPECT_EQ(verdict.kind, VerdictKind::reproduced);
    EXPECT_EQ(verdict.cases.size(), 2u);  // one case with two metrics
    ASSERT_EQ(verdict.compared.size(), 1u);
    EXPECT_EQ(verdict.compared[0].scene, "walk_4800");
    finer.beside = false;
    EXPECT_EQ(judge(claim_of("C02"), {.cases = {walk, finer}}).kind, VerdictKind::reproduced_only_for);
}

}  // namespace

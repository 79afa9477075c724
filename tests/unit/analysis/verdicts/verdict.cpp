// Verdicts are computed: each kind follows from its records and changes when they are altered. Reference: the rules in
// experiments/verdicts/claims.toml.
#include "analysis/verdicts/verdict.hpp"

#include "analysis/records/record_files.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

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

// The record with other changes in the frames from `first` to `last`.
CaseRecord changed(CaseRecord record, int first, int last, double change_pct)
{
    for (int frame = first; frame <= last; ++frame) {
        record.volume_change_pct[frame] = change_pct;
        record.volume_abs_change_pct[frame] = 2.0 * std::abs(change_pct);
    }
    return record;
}

CaseRecord with_abs(CaseRecord record, double abs_change_pct)
{
    record.volume_abs_change_pct = constant(static_cast<int>(record.frame.size()), abs_change_pct);
    return record;
}

Verdict verdict_on(const std::string& id, const std::vector<CaseRecord>& cases)
{
    return judge(claim_of(id), {.cases = cases});
}

struct KindCase {
    const char* name;
    std::string claim;  // C01: LBS loses 12 to 16 % in the mean; C02: PBS stays within 0.5 % in 95 % of the frames
    std::vector<CaseRecord> cases;
    VerdictKind kind;
};

TEST(Verdict, KindFollowsFromTheRecords)
{
    using enum VerdictKind;
    const auto walk = [](double change_pct, int frames = 100) { return clip("walk", "pbs", 24, constant(frames, change_pct)); };
    const auto twist = [](const std::vector<double>& change_pct) { return sweep("twist", "pbs", 24, change_pct); };
    const auto lbs = [](double change_pct) { return clip("walk", "lbs", 0, constant(100, change_pct)); };
    std::vector<double> noisy_loss;
    for (int i = 0; i < 100; ++i) noisy_loss.push_back(-12.1 + (i % 2 == 0 ? 3.0 : -3.0));
    const CaseRecord tenth_fails = changed(walk(-0.3), 20, 29, -0.51);
    const std::vector<double> to_60_deg = {0, -0.1, -0.2, -0.3, -0.5, -0.4, -0.5};
    const std::vector<KindCase> all = {
        {"a clip within the bound", "C02", {walk(-0.3)}, reproduced},
        {"90 % of the frames hold", "C02", {tenth_fails}, not_reproduced},
        {"another case holds", "C02", {tenth_fails, twist(constant(9, 0.1))}, reproduced_only_for},
        {"a gain counts like a loss", "C02", {walk(0.6, 30)}, not_reproduced},
        {"a sweep on its bound", "C02", {twist(to_60_deg)}, reproduced},
        {"a claim that holds in the rest pose alone", "C02", {changed(twist(to_60_deg), 1, 1, -0.7)}, not_reproduced},
        {"the rest pose is no sweep", "C02", {twist({0.0})}, not_reproduced},
        {"up to 40 of 200 deg: less than one quarter", "C02", {changed(twist(constant(21, -2.0)), 0, 4, 0.0)}, not_reproduced},
        {"up to 50 of 200 deg", "C02", {changed(twist(constant(21, -2.0)), 0, 5, 0.0)}, reproduced_only_for},
        {"other deformers and iterations decide nothing",
         "C02",
         {walk(0.0), clip("walk", "lbs", 24, constant(30, -9.0)), clip("walk", "pbs", 4, constant(30, -9.0))},
         reproduced},
        {"only other deformers and iterations",
         "C02",
         {clip("walk", "lbs", 24, constant(30, -9.0)), clip("walk", "pbs", 4, constant(30, -9.0))},
         not_computable},
        {"no frames", "C01", {clip("walk", "lbs", 0, {})}, not_computable},
        {"no records", "C01", {}, not_computable},
        {"a mean in the band", "C01", {lbs(-14.0)}, reproduced},
        {"the interval of the mean leaves the band", "C01", {with_abs(clip("walk", "lbs", 0, noisy_loss), 1.0)}, reproduced_only_for},
        {"a mean outside of the band", "C01", {with_abs(lbs(-11.9), 28.0)}, not_reproduced},
        {"a gain is no loss", "C01", {with_abs(lbs(14.0), 28.0)}, not_reproduced},
        {"the absolute change is in the band", "C01", {with_abs(lbs(14.0), 12.5)}, reproduced_only_for},
    };
    for (const KindCase& of : all) EXPECT_EQ(verdict_on(of.claim, of.cases).kind, of.kind) << of.name;
}

TEST(VolumeIsPreserved, ReproducedWhereEveryCaseHolds)
{
    const auto walk = clip("walk", "pbs", 24, constant(100, -0.3));
    const auto twist = sweep("twist", "pbs", 24, constant(18, -0.5));  // a value on the bound is within
    const Verdict verdict = verdict_on("C02", {walk, twist});
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

TEST(VolumeIsPreserved, ShareAboveTheBoundWithAnIntervalBelowItDoesNotHold)
{
    const auto walk = changed(clip("walk", "pbs", 24, constant(100, 0.0)), 40, 42, -2.0);  // 97 % hold, and the failures are consecutive
    const Verdict verdict = verdict_on("C02", {walk});
    EXPECT_NEAR(verdict.interval.estimate, 0.97, test_support::mean_error(100, 0.97));
    EXPECT_LT(verdict.interval.low, 0.95);
    EXPECT_EQ(verdict.kind, VerdictKind::not_reproduced);
}

TEST(VolumeIsPreserved, TheClipWithTheLowestShareRepresentsTheClaimInAnyVariant)
{
    CaseRecord walk = clip("walk", "pbs", 24, constant(100, -0.6)), jiggling = clip("jump", "pbs", 24, constant(100, -0.6));
    jiggling.variant = "jiggle";
    walk = changed(walk, 3, 3, 0.0);
    EXPECT_EQ(verdict_on("C02", {walk, jiggling}).primary->of.body, "jump");
    jiggling = changed(changed(jiggling, 3, 3, 0.0), 60, 60, 0.0);
    EXPECT_EQ(verdict_on("C02", {walk, jiggling}).primary->of.body, "walk");
}

TEST(VolumeIsPreserved, SweepHoldsUpToItsFirstFailure)
{
    const auto twist = sweep("twist", "pbs", 24, {0, -0.1, -0.2, -0.3, -0.6, -0.4, -0.9});
    const Verdict verdict = verdict_on("C02", {twist});
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

    EXPECT_EQ(verdict_on("C02", {changed(twist, 4, 4, -0.5)}).cases[0].angles[0].to_deg, 50.0);
}

TEST(VolumeIsPreserved, InvertedTetsInFramesThatHoldAreTold)
{
    auto bend = sweep("bend", "pbs", 24, constant(10, -0.2));
    bend.inverted_tets[7] = bend.inverted_tets[9] = 15.0;
    const Verdict verdict = verdict_on("C02", {bend});
    EXPECT_EQ(verdict.cases[0].holding_with_inverted_tets, 2);
}

TEST(VolumeIsPreserved, BreakdownDoesNotHold)
{
    const auto walk = changed(clip("walk", "pbs", 24, constant(60, -0.3)), 30, 59, std::numeric_limits<double>::quiet_NaN());
    const Verdict verdict = verdict_on("C02", {walk});
    EXPECT_EQ(verdict.kind, VerdictKind::not_reproduced);
    EXPECT_EQ(verdict.cases[0].share.estimate, 0.5);
    EXPECT_EQ(verdict.cases[0].deepest[0].frame, 30.0);
    EXPECT_TRUE(std::isnan(verdict.cases[0].least));
}

TEST(VolumeIsPreserved, OtherDeformersAreComparedAndDecideNothing)
{
    const auto good = clip("walk", "pbs", 24, constant(100, 0.0)), reference = clip("walk", "fem_p2", 0, constant(100, 7.0));
    const Verdict verdict = verdict_on("C02", {good, reference});
    EXPECT_EQ(verdict.kind, VerdictKind::reproduced);
    ASSERT_EQ(verdict.compared.size(), 1u);
    EXPECT_EQ(verdict.compared[0].deformer, "fem_p2");
    EXPECT_EQ(verdict.compared[0].extent, Extent::none);
    EXPECT_NEAR(verdict.compared[0].mean.estimate, 7.0, test_support::mean_error(100, 7.0));
}

TEST(LossOfLbs, ReproducedWhereTheMeansLieInTheBand)
{
    const Verdict verdict = verdict_on("C01", {clip("walk", "lbs", 0, {-13, -14, -15, -14, -13, -14})});
    EXPECT_EQ(verdict.kind, VerdictKind::reproduced);
    EXPECT_NEAR(verdict.interval.estimate, 83.0 / 6.0, test_support::mean_error(6, 83.0 / 6.0));
    ASSERT_TRUE(verdict.primary);
    EXPECT_EQ(verdict.primary->statistic, "mean");
    EXPECT_EQ(verdict.primary->quantity, "volume_loss_pct");
    EXPECT_EQ(verdict.primary->bound_high, 16.0);
    EXPECT_LE(verdict.interval.low, verdict.interval.estimate);
}

TEST(LossOfLbs, IsCountedByTheClaimsOwnMetric)
{
    const Verdict verdict = verdict_on("C01", {with_abs(clip("walk", "lbs", 0, constant(20, 14.0)), 12.5)});
    EXPECT_EQ(verdict.within, 0);
    EXPECT_EQ(verdict.cases.at(1).metric, "volume_abs_change_pct");
    EXPECT_EQ(verdict.cases.at(1).extent, Extent::whole);
}

TEST(LossOfLbs, MeanOutsideWithFramesInTheBandIsAPart)
{
    auto walk = clip("walk", "lbs", 0, {-2, -3, -13, -14, -4, -2});
    walk.volume_abs_change_pct = constant(6, 1.0);
    const Verdict verdict = verdict_on("C01", {walk});
    EXPECT_EQ(verdict.kind, VerdictKind::reproduced_only_for);
    EXPECT_EQ(verdict.cases[0].extent, Extent::part);
    EXPECT_NEAR(verdict.cases[0].share.estimate, 1.0 / 3.0, test_support::mean_error(6, 1.0 / 3.0));
}

TEST(LossOfLbs, SweepTellsTheAnglesThatReachTheBand)
{
    auto twist = sweep("twist", "lbs", 0, {0, -4, -9, -13, -15, -17, -14});
    twist.volume_abs_change_pct = constant(7, 1.0);
    const Verdict verdict = verdict_on("C01", {twist});
    EXPECT_EQ(verdict.kind, VerdictKind::reproduced_only_for);
    ASSERT_EQ(verdict.cases[0].angles.size(), 2u);
    EXPECT_EQ(verdict.cases[0].angles[0].from_deg, 30.0);
    EXPECT_EQ(verdict.cases[0].angles[0].to_deg, 40.0);
    EXPECT_EQ(verdict.cases[0].angles[1].from_deg, 60.0);
    EXPECT_EQ(verdict.cases.at(1).extent, Extent::none);
}

TEST(Verdict, MissingRecordsAreNoResult)
{
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
    const Verdict verdict = verdict_on("C02", {walk, other});
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
    EXPECT_TRUE(verdict_on("C02", {walk, plain}).orders.at(0).same());
    EXPECT_FALSE(verdict_on("C02", {walk, changed(plain, 20, 29, -0.51)}).orders.at(0).same());
}

TEST(OtherOrders, AreComparedOnTheScenesTheyWereRecordedOn)
{
    const auto walk = clip("walk", "pbs", 24, constant(100, -0.9));  // fails, and was recorded in only one order
    const auto twist = sweep("twist", "pbs", 24, constant(18, -0.3));
    const Verdict verdict = verdict_on("C02", {walk, twist, in_order(twist, "grouped", "f32"), in_order(twist, "grouped", "f64")});
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
    EXPECT_TRUE(verdict_on("C02", {walk, other}).orders.empty());
}

TEST(VolumeIsPreserved, TheSameBodyOnAnotherMeshIsShownAndNotJudged)
{
    const auto walk = clip("walk", "pbs", 24, constant(100, -0.3));
    auto finer = clip("walk_4800", "pbs", 24, constant(100, -3.0));
    finer.beside = true;
    const Verdict verdict = verdict_on("C02", {walk, finer});
    EXPECT_EQ(verdict.kind, VerdictKind::reproduced);
    EXPECT_EQ(verdict.cases.size(), 2u);  // one case with two metrics
    ASSERT_EQ(verdict.compared.size(), 1u);
    EXPECT_EQ(verdict.compared[0].scene, "walk_4800");
    finer.beside = false;
    EXPECT_EQ(verdict_on("C02", {walk, finer}).kind, VerdictKind::reproduced_only_for);
}

}  // namespace

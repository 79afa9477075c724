// Verdicts are computed: each kind follows from its records and changes when they are altered. Reference: the rules in
// experiments/verdicts/claims.toml. C01: LBS loses 12 to 16 % in the mean; C02: PBS stays within 0.5 % in 95 % of the frames.
#include "analysis/verdicts/verdict.hpp"

#include "analysis/records/record_files.hpp"
#include "analysis/records/report_table.hpp"
#include "tests/support/json_facts.hpp"
#include "tests/support/rounding_error.hpp"

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

CaseRecord walk(double change_pct, int frames = 100)
{
    return clip("walk", "pbs", 24, constant(frames, change_pct));
}

CaseRecord twist(const std::vector<double>& change_pct, const std::string& deformer = "pbs")
{
    return sweep("twist", deformer, deformer == "pbs" ? 24 : 0, change_pct);
}

CaseRecord lbs(const std::vector<double>& change_pct)
{
    return clip("walk", "lbs", 0, change_pct);
}

CaseRecord in_order(CaseRecord record, const std::string& order, const std::string& precision, int iterations = 24)
{
    record.deformer = "pbs_orders";
    record.order = order;
    record.precision = precision;
    record.iterations = iterations;
    return record;
}

void expect_facts(const Verdict& verdict, const std::string& facts)
{
    test_support::expect_facts(claims_json({verdict}, "").at("claims").at(0), facts);
}

// facts: values of the claim's object in claims.json.
Verdict judged(const char* name, const std::vector<CaseRecord>& cases, VerdictKind kind, const std::string& facts = "{}",
               const std::string& claim = "C02")
{
    SCOPED_TRACE(name);
    const Verdict verdict = judge(claim_of(claim), {.cases = cases});
    EXPECT_EQ(verdict.kind, kind);
    expect_facts(verdict, facts);
    return verdict;
}

using enum VerdictKind;

TEST(Verdict, OfVolumeFollowsFromTheClips)
{
    judged("clips within the bound, and a sweep on it", {walk(-0.3), twist(constant(18, -0.5))}, reproduced,
           R"({"runs": ["volume/twist", "volume/walk"], "interval": {"estimate": 1.0}, "within": 2, "n": 2,
               "primary": {"statistic": "share_of_frames", "body": "walk", "bound_low": 0.95}, "cases": [{}, {}, {}, {}]})");
    const CaseRecord tenth_fails = changed(walk(-0.3), 20, 29, -0.51);
    judged("90 % of the frames hold", {tenth_fails}, not_reproduced);
    judged("another case holds", {tenth_fails, twist(constant(9, 0.1))}, reproduced_only_for);
    judged("a gain counts like a loss", {walk(0.6, 30)}, not_reproduced);
    const Verdict failures_in_a_row = judged("97 % of the frames hold", {changed(walk(0.0), 40, 42, -2.0)}, not_reproduced);
    EXPECT_NEAR(failures_in_a_row.interval.estimate, 0.97, test_support::mean_error(100, 0.97));
    EXPECT_LT(failures_in_a_row.interval.low, 0.95);
    judged("a breakdown", {changed(walk(-0.3, 60), 30, 59, std::nan(""))}, not_reproduced,
           R"({"cases": [{"share_of_frames": {"estimate": 0.5}, "deepest": [{"frame": 30}, {}, {}], "least": null}, {}]})");

    const CaseRecord other_deformer = clip("walk", "lbs", 24, constant(30, -9.0)),
                     other_iterations = clip("walk", "pbs", 4, constant(30, -9.0));
    judged("other deformers and iterations decide nothing", {walk(0.0), other_deformer, other_iterations}, reproduced);
    judged("only other deformers and iterations", {other_deformer, other_iterations}, not_computable);
    const Verdict compared = judged("other deformers are compared", {walk(0.0), clip("walk", "fem_p2", 0, constant(100, 7.0))}, reproduced,
                                    R"({"controls": [{"deformer": "fem_p2", "holds": "none"}]})");
    EXPECT_NEAR(compared.compared[0].mean.estimate, 7.0, test_support::mean_error(100, 7.0));

    const CaseRecord one_holds = changed(walk(-0.6), 3, 3, 0.0);
    CaseRecord jump = clip("jump", "pbs", 24, constant(100, -0.6));
    jump.variant = "jiggle";
    judged("the lowest share represents a claim in any variant", {one_holds, jump}, not_reproduced, R"({"primary": {"body": "jump"}})");
    jump = changed(changed(jump, 3, 3, 0.0), 60, 60, 0.0);
    judged("here that of the walk", {one_holds, jump}, not_reproduced, R"({"primary": {"body": "walk"}})");

    CaseRecord finer = clip("walk_4800", "pbs", 24, constant(100, -3.0));
    judged("another mesh as a case of its own", {walk(-0.3), finer}, reproduced_only_for);
    finer.beside = true;
    judged("the same body on another mesh is shown and not judged", {walk(-0.3), finer}, reproduced,
           R"({"controls": [{"scene": "walk_4800"}], "cases": [{}, {}]})");
}

TEST(Verdict, OfVolumeFollowsFromTheSweeps)
{
    const std::vector<double> to_60_deg = {0, -0.1, -0.2, -0.3, -0.5, -0.4, -0.5};
    judged("on its bound", {twist(to_60_deg)}, reproduced);
    judged("holds in the rest pose alone", {changed(twist(to_60_deg), 1, 1, -0.7)}, not_reproduced);
    judged("the rest pose is no sweep", {twist({0.0})}, not_reproduced);
    judged("up to 40 of 200 deg: less than one quarter", {changed(twist(constant(21, -2.0)), 0, 4, 0.0)}, not_reproduced);
    judged("up to 50 of 200 deg", {changed(twist(constant(21, -2.0)), 0, 5, 0.0)}, reproduced_only_for);
    const CaseRecord fails_at_40_deg = twist({0, -0.1, -0.2, -0.3, -0.6, -0.4, -0.9});
    judged("up to its first failure, and without a primary value", {fails_at_40_deg}, reproduced_only_for,
           R"({"primary": null,
               "cases": [{"held_angles_deg": [[0, 30]], "deepest": [{"angle_deg": 60, "value": -0.9}, {}], "last_angle_deg": 60,
                          "holds": "part"},
                         {"quantity": "volume_abs_change_pct", "held_angles_deg": [[0, 20]]}]})");
    judged("up to the next one", {changed(fails_at_40_deg, 4, 4, -0.5)}, reproduced_only_for,
           R"({"cases": [{"held_angles_deg": [[0, 50]]}, {}]})");
    CaseRecord bend = sweep("bend", "pbs", 24, constant(10, -0.2));
    bend.inverted_tets[7] = bend.inverted_tets[9] = 15.0;
    judged("inverted tets in frames that hold", {bend}, reproduced, R"({"cases": [{"holding_with_inverted_tets": 2}, {}]})");
}

TEST(Verdict, OfTheLossOfLbsFollowsFromTheRecords)
{
    const auto loss = [](const char* name, const std::vector<CaseRecord>& cases, VerdictKind kind, const std::string& facts = "{}") {
        return judged(name, cases, kind, facts, "C01");
    };
    std::vector<double> noisy;
    for (int i = 0; i < 100; ++i) noisy.push_back(-12.1 + (i % 2 == 0 ? 3.0 : -3.0));
    loss("no frames", {lbs({})}, not_computable);
    loss("no records", {}, not_computable);
    loss("a mean in the band", {lbs(constant(100, -14.0))}, reproduced);
    loss("the interval of the mean leaves the band", {with_abs(lbs(noisy), 1.0)}, reproduced_only_for);
    loss("a mean outside of the band", {with_abs(lbs(constant(100, -11.9)), 28.0)}, not_reproduced);
    loss("a gain is no loss", {with_abs(lbs(constant(100, 14.0)), 28.0)}, not_reproduced);
    loss("the absolute change is in the band", {with_abs(lbs(constant(20, 14.0)), 12.5)}, reproduced_only_for,
         R"({"within": 0, "cases": [{}, {"quantity": "volume_abs_change_pct", "holds": "whole"}]})");
    const Interval mean = loss("means in the band", {lbs({-13, -14, -15, -14, -13, -14})}, reproduced,
                               R"({"primary": {"statistic": "mean", "quantity": "volume_loss_pct", "bound_high": 16}})")
                              .interval;
    EXPECT_NEAR(mean.estimate, 83.0 / 6.0, test_support::mean_error(6, 83.0 / 6.0));
    EXPECT_LE(mean.low, mean.estimate);
    const Verdict part = loss("a mean outside with frames in the band", {with_abs(lbs({-2, -3, -13, -14, -4, -2}), 1.0)},
                              reproduced_only_for, R"({"cases": [{"holds": "part"}, {}]})");
    EXPECT_NEAR(part.cases[0].share.estimate, 1.0 / 3.0, test_support::mean_error(6, 1.0 / 3.0));
    loss("angles of a sweep that reach the band", {with_abs(twist({0, -4, -9, -13, -15, -17, -14}, "lbs"), 1.0)}, reproduced_only_for,
         R"({"cases": [{"held_angles_deg": [[30, 40], [60, 60]]}, {"holds": "none"}]})");
}

TEST(Verdict, MissingRecordsAreNoResultAndWhatWasLeftOutIsTold)
{
    const std::vector<CaseRecord> cases = {lbs(constant(20, -14.0))};
    Records records{.cases = cases, .planned_scenes = {"walk", "twist"}};
    const Verdict verdict = judge(claim_of("C01"), records);
    EXPECT_EQ(verdict.kind, not_computable);
    EXPECT_EQ(verdict.missing, std::vector<std::string>{"twist"});
    records.left_out = {{"twist", "package missing"}};
    EXPECT_EQ(judge(claim_of("C01"), records).kind, reproduced);
    for (const auto& [of, kind] : {std::pair(cases, reproduced), {{}, cannot_be_tested_here}}) {
        const Verdict told = judge(claim_of("C01"), {.cases = of, .left_out = records.left_out});
        EXPECT_EQ(told.kind, kind);
        expect_facts(told, R"({"left_out": [{"scene": "twist", "reason": "package missing"}]})");
    }
}

TEST(Verdict, ValuesInPrintFlipWithTheirBoundsAndUntestableClaimsSayWhy)
{
    Claim claim = claim_of("C01");
    claim.rule = ClaimRule::printed;
    claim.reason = "no published figures";
    const double infinity = std::numeric_limits<double>::infinity();
    Records records{.printed = {{claim.id, "edges", {.model = "Man"}, 6342, 6653, infinity},
                                {claim.id, "edges", {.model = "Lady"}, 9387, 7862, infinity},
                                {"C00", "another", {}, 1, 2, 3}}};
    EXPECT_EQ(judge(claim, records).kind, inconsistent_in_print);
    expect_facts(judge(claim, records), R"({"primary": {"model": "Man", "value": 6342, "bound_low": 6653}, "within": 1, "n": 2})");
    records.printed[0].printed = 6653;
    EXPECT_EQ(judge(claim, records).kind, reproduced);
    EXPECT_EQ(judge(claim, {}).kind, not_computable);
    claim.rule = ClaimRule::untestable;
    EXPECT_EQ(judge(claim, {}).kind, cannot_be_tested_here);
    EXPECT_EQ(judge(claim, {}).claim.reason, "no published figures");
}

TEST(OtherOrders, AreJudgedByThemselvesOnTheirScenesAndAreNoPartOfTheVerdict)
{
    const CaseRecord held = walk(-0.3), twisted = twist(constant(18, -0.3)), plain = in_order(held, "plain", "f32");
    judged("one that fails; the absolute change holds in neither", {held, in_order(walk(-0.9), "plain", "f64")}, reproduced,
           R"({"readings": [{"verdict": "not_reproduced", "own_verdict": "reproduced", "differing": [0],
                             "cases": [{"quantity": "volume_change_pct", "order": "plain"}, {}]}], "cases": [{}, {}]})");
    judged("the same values", {held, plain}, reproduced, R"({"readings": [{"same": true}]})");
    judged("altered ones", {held, changed(plain, 20, 29, -0.51)}, reproduced, R"({"readings": [{"same": false}]})");
    judged("a walk that fails, recorded in one order alone",
           {walk(-0.9), twisted, in_order(twisted, "grouped", "f32"), in_order(twisted, "grouped", "f64")}, reproduced_only_for,
           R"({"readings": [{"own_verdict": "reproduced", "same": true}, {"same": true}]})");
    judged("other iterations", {held, in_order(held, "plain", "f32", 12)}, reproduced, R"({"readings": []})");
}

}  // namespace

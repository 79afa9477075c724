// Reference: the rule at the head of claims.toml, with counts chosen by hand: thresholds that are met exactly, and
// values that are missing or censored. tests/claims/recomputed.py computes all verdicts on the kept records a second
// time.
#include "analysis/verdicts/verdict.hpp"

#include "analysis/records/record_files.hpp"
#include "analysis/records/report_table.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace verdict_tests {
namespace {

using namespace analysis;
using enum VerdictKind;

// A claim on the radius of PBS at the joints of bodies: at least 0.9. LBS must fail, flesh must hold.
Claim radius_claim()
{
    Claim claim{.id = "X01", .statement = "It | holds", .place = "Sec. 1", .study = "artefacts"};
    claim.short_name = "it holds";
    claim.headline = "in {held} of {n} joints";
    claim.case_fields = {"body", "joint"};
    claim.source = "Sec. 1";
    claim.own = {.name = "X01", .quantities = {"radius"}, .of = {.deformer = "pbs"}, .thresholds = {{.low = 0.9}}};
    claim.others = {claim.own, claim.own, claim.own};
    const std::array<std::tuple<const char*, Role, const char*>, 3> others = {
        {{"LBS", Role::negative_control, "lbs"},
         {"flesh", Role::positive_control, "flesh"},
         {"DQS", Role::comparison, "dqs"}}};
    for (std::size_t i = 0; i < others.size(); ++i) {
        std::tie(claim.others[i].name, claim.others[i].role, claim.others[i].of.deformer) = others[i];
        claim.others[i].of.order = "";
    }
    return claim;
}

Measurement radius(const std::string& deformer, int joint, double value)
{
    const std::string body = joint % 2 ? "odd" : "even";
    const CaseKey key = {.body = body, .joint = std::to_string(joint), .deformer = deformer};
    return {.claim = "X01",
            .quantity = "radius",
            .of = key,
            .value = value,
            .low = value,
            .high = value,
            .unit = "1",
            .run = "a/run"};
}

// `held` of `cases` joints hold for PBS, none for LBS, all for flesh.
Records records_of(int held, int cases)
{
    Records records;
    for (int joint = 0; joint < cases; ++joint)
        for (const auto& [deformer, value] :
             {std::pair{"pbs", joint < held ? 0.95 : 0.5}, {"lbs", 0.2}, {"flesh", 1.0}, {"dqs", 0.7}})
            records.measurements.push_back(radius(deformer, joint, value));
    return records;
}

Verdict verdict_on(int held, int cases)
{
    return judge(radius_claim(), records_of(held, cases));
}

TEST(Verdict, FollowsFromTheShareOfTheCases)
{
    struct Case {
        int held, cases;
        VerdictKind kind;
    };
    for (const auto& [held, cases, kind] : {Case{20, 20, holds},
                                            {19, 20, holds},
                                            {18, 20, mixed},
                                            {11, 20, mixed},
                                            {10, 20, fails},
                                            {0, 20, fails},
                                            {5, 5, holds},
                                            {4, 4, inconclusive},
                                            {0, 0, inconclusive}})
        EXPECT_EQ(verdict_on(held, cases).kind, kind) << held << " of " << cases;
    EXPECT_EQ(verdict_on(4, 4).inconclusive, Inconclusive::too_few_cases);
    const Verdict verdict = verdict_on(18, 20);
    EXPECT_EQ(verdict.own.held, 18);
    EXPECT_EQ(verdict.own.n, 20);
    EXPECT_EQ(verdict.runs, std::vector<std::string>{"a/run"});
}

TEST(Verdict, IsInconclusiveIfAControlMisbehavesOrHasNoRecord)
{
    const auto with = [](std::size_t control, double value, int cases) {  // 1: LBS, 2: flesh
        Records records = records_of(20, 20);
        for (int i = 0; i < cases; ++i) records.measurements[static_cast<std::size_t>(4 * i) + control].value = value;
        return judge(radius_claim(), records);
    };
    EXPECT_EQ(with(1, 1.0, 10).kind, holds) << "LBS fails in half of its cases";
    EXPECT_EQ(with(1, 1.0, 11).inconclusive, Inconclusive::control_misbehaves);
    EXPECT_EQ(with(2, 0.1, 1).kind, holds) << "flesh holds in 95 %";
    EXPECT_EQ(with(2, 0.1, 2).kind, inconclusive);
    Records records = records_of(20, 20);
    std::erase_if(records.measurements, [](const Measurement& one) { return one.of.deformer == "flesh"; });
    EXPECT_EQ(judge(radius_claim(), records).inconclusive, Inconclusive::control_without_record);
    std::erase_if(records.measurements, [](const Measurement& one) { return one.of.deformer == "dqs"; });
    EXPECT_FALSE(judge(radius_claim(), records).others[2].n) << "a comparison without a record changes nothing";
}

TEST(Verdict, TheControlThatSelectsTheCasesMustFailInFiveOfThem)
{
    Claim claim = radius_claim();
    claim.selected_by = "LBS";
    const auto with_lbs_failing_in = [&](int cases) {
        Records records = records_of(20, 20);
        for (int i = cases; i < 20; ++i) records.measurements[static_cast<std::size_t>(4 * i + 1)].value = 1.0;
        return judge(claim, records);
    };
    EXPECT_EQ(with_lbs_failing_in(5).kind, holds) << "it holds in 15 of 20";
    const Verdict four = with_lbs_failing_in(4);
    EXPECT_EQ(four.kind, inconclusive);
    EXPECT_EQ(four.inconclusive, Inconclusive::control_misbehaves);
    Records records = records_of(20, 20);
    std::erase_if(records.measurements, [](const Measurement& one) { return one.of.deformer == "lbs"; });
    EXPECT_EQ(judge(claim, records).inconclusive, Inconclusive::control_without_record);
    records = records_of(20, 20);
    for (int i = 0; i < 16; ++i)
        std::erase_if(records.measurements, [&](const Measurement& one) {
            return one.of.deformer == "pbs" && one.of.joint == std::to_string(i);
        });
    EXPECT_EQ(judge(claim, records).inconclusive, Inconclusive::too_few_cases) << "it fails in cases that PBS lacks";
}

TEST(Verdict, CensoredValuesDecideOnlyWhatTheyBound)
{
    struct Case {
        double value;
        Limit limit;
        Threshold threshold;
        bool counts, holds;
    };
    const Threshold least = {.low = 1.05}, most = {.high = 24.0};
    for (const auto& [value, limit, threshold, counts, holds] :
         {Case{1.3, Limit::at_least, least, true, true}, Case{0.9, Limit::at_least, least, false, false},
          Case{0.9, Limit::at_most, least, true, false}, Case{1.3, Limit::at_most, least, false, true},
          Case{1000, Limit::more_than, most, true, false}, Case{10, Limit::more_than, most, false, true}}) {
        Claim claim = radius_claim();
        claim.own.thresholds = {threshold};
        Measurement censored = radius("pbs", 0, value);
        censored.limit = limit;
        const Judged of = judged(claim, claim.own, {censored});
        EXPECT_EQ(of.cases[0].counts(), counts) << value;
        EXPECT_EQ(of.cases[0].holds, holds) << value;
        EXPECT_EQ(of.cases[0].limit, limit);
    }
}

TEST(Verdict, OfAMeanWithALeastAndAMostNumberNothingIsKnown)
{
    const Claim claim = radius_claim();
    std::vector<Measurement> measured = {radius("pbs", 0, 0.8), radius("pbs", 0, 2.0)};
    std::tie(measured[0].limit, measured[1].limit) = std::pair(Limit::at_most, Limit::at_least);
    EXPECT_FALSE(judged(claim, claim.own, measured).cases[0].counts());
    std::ranges::reverse(measured);
    EXPECT_FALSE(judged(claim, claim.own, measured).cases[0].counts());
}

TEST(Verdict, AFieldThatACaseLacksIsNoPropertyByWhichCasesDiffer)
{
    Claim claim = radius_claim();
    claim.case_fields = {"joint", "pose"};
    Records records = records_of(8, 12);
    for (Measurement& one : records.measurements)
        if (const int joint = std::stoi(one.of.joint); joint >= 6) one.of.pose = joint % 2 ? "crouch" : "landing";
    EXPECT_FALSE(judge(claim, records).differs)
        << "with a pose the share is a third for both; without one there is no pose to name";
}

TEST(Verdict, ACaseOfSeveralQuantitiesHoldsIfAllDo)
{
    Claim claim = radius_claim();
    claim.own.quantities = {"radius", "area"};
    claim.own.thresholds = {{.low = 0.9, .quantity = "radius"}, {.high = 2.0, .quantity = "area"}};
    std::vector<Measurement> measured = {radius("pbs", 0, 1.0), radius("pbs", 2, 1.0), radius("pbs", 4, 1.0),
                                         radius("pbs", 0, 1.5), radius("pbs", 2, 2.5)};
    measured[3].quantity = measured[4].quantity = "area";
    const Judged of = judged(claim, claim.own, measured);
    EXPECT_EQ(of.n, 3);
    EXPECT_EQ(of.held, 1) << "the third has no area";
    EXPECT_EQ(of.cases[0].value, 1.0);
    claim.case_fields.push_back("quantity");
    EXPECT_EQ(judged(claim, claim.own, measured).n, 5);
    EXPECT_EQ(judged(claim, claim.own, measured).held, 4);
}

TEST(Verdict, UsesRunsBesideTheOthersOnlyWhereThereAreNoOthers)
{
    Claim claim = radius_claim();
    std::vector<Measurement> measured = {radius("pbs", 0, 1.0), radius("pbs", 0, 0.1), radius("flesh", 0, 1.0)};
    measured[1].beside = measured[2].beside = true;
    EXPECT_EQ(judged(claim, claim.own, measured).cases[0].value, 1.0);
    EXPECT_EQ(judged(claim, claim.others[1], measured).n, 1);
}

TEST(Verdict, OneNumberIsJudgedByItsRange)
{
    Claim claim = radius_claim();
    claim.rule = ClaimRule::single;
    const auto kind = [&](double low, double high) {
        Measurement measured = radius("pbs", 0, 0.5 * (low + high));
        measured.low = low;
        measured.high = high;
        return judge(claim, {.measurements = {measured}}).kind;
    };
    EXPECT_EQ(kind(0.9, 1.0), holds);
    EXPECT_EQ(kind(0.8, 1.0), mixed);
    EXPECT_EQ(kind(0.7, 0.8), fails);
    EXPECT_EQ(kind(0.7, NAN), fails);
    EXPECT_EQ(judge(claim, records_of(2, 2)).kind, inconclusive) << "two numbers";
}

TEST(Verdict, ShowsTheClaimInEachOrderAndPrecision)
{
    Claim claim = radius_claim();
    claim.own.of.order = "plain";
    claim.own.of.precision = "f64";
    Records records = records_of(20, 20);
    const std::vector<Measurement> all = records.measurements;
    for (Measurement& one : records.measurements)
        if (one.of.deformer == "pbs") one.of.order = "plain", one.of.precision = "f64";
    for (Measurement one : all)
        if (one.of.deformer == "pbs") {
            one.of.order = "ordered", one.of.precision = "f32", one.value = 0.1;
            records.measurements.push_back(one);
        }
    const Verdict verdict = judge(claim, records);
    EXPECT_EQ(verdict.kind, holds);
    ASSERT_EQ(verdict.readings.size(), 1u);
    EXPECT_EQ(verdict.readings[0].selection.name, "ordered f32");
    EXPECT_EQ(verdict.readings[0].held, 0);
}

TEST(Verdict, MissingRecordsAreNoResult)
{
    Records records = records_of(20, 20);
    records.missing_runs = {"a/second"};
    EXPECT_EQ(judge(radius_claim(), records).kind, not_computable);
    records = records_of(20, 20);
    records.planned_scenes = {"walk"};
    EXPECT_EQ(judge(radius_claim(), records).missing, std::vector<std::string>{"walk"});
    records.left_out = {{"walk", "not installed"}};
    EXPECT_EQ(judge(radius_claim(), records).kind, holds);
    EXPECT_EQ(judge({.id = "C14", .rule = ClaimRule::printed}, {}).kind, not_computable);
}

// Reference: the contract of claims.json, claims.md and the terminal's table.

TEST(ClaimsReport, OneRowPerClaim)
{
    const std::string table = claims_markdown({verdict_on(20, 20)});
    EXPECT_NE(table.find("| X01 | It \\| holds | holds | in 20 of 20 joints | 95 % | 20 | 20 | 1 | [0.832, 1] | "),
              std::string::npos)
        << table;
    EXPECT_EQ(std::ranges::count(table, '\n'), 3);
    Verdict free = verdict_on(20, 20);
    free.claim.own.thresholds.clear();
    EXPECT_NE(claims_markdown({free}).find("| 95 % |  | 20 |"), std::string::npos) << "without a threshold none holds";
}

TEST(ClaimsReport, StatesWhyAVerdictIsInconclusiveOrNotShown)
{
    Claim claim = radius_claim();
    claim.no_effect = 0.5;
    EXPECT_NE(claims_markdown({judge(claim, records_of(14, 18))})
                  .find("| chance reaches as many with a probability of 0.015 |"),
              std::string::npos);
    EXPECT_NE(claims_markdown({verdict_on(4, 4)}).find("| too few cases |"), std::string::npos);
    Records records = records_of(20, 20);
    for (int i = 0; i < 11; ++i) records.measurements[static_cast<std::size_t>(4 * i + 1)].value = 1.0;
    EXPECT_NE(claims_markdown({judge(radius_claim(), records)}).find("| negative control LBS: 11 of 20 hold |"),
              std::string::npos);
}

TEST(ClaimsReport, TheTerminalsTableHasOneLinePerClaimWithinItsWidthAndCountsTheVerdicts)
{
    const FurtherColumn here = {.heading = "here", .texts = {{"X01", "94 numbers agree"}}};
    for (const std::size_t width : {60u, 100u}) {
        for (const FurtherColumn& further : {FurtherColumn{}, here}) {
            const std::string table = claims_table({verdict_on(18, 20), verdict_on(4, 4)}, width, false, further);
            std::istringstream lines(table);
            for (std::string line; std::getline(lines, line);) EXPECT_LE(characters(line), width) << line;
            EXPECT_EQ(std::ranges::count(table, '\n'), 4) << table;
            EXPECT_NE(table.find("2 claims: 1 mixed, 1 inconclusive"), std::string::npos) << table;
        }
    }
    EXPECT_EQ(claims_table({verdict_on(18, 20)}, 100, false, here),
              "     claim of the paper  verdict  measured            here\n"
              "X01  it holds            MIXED    in 18 of 20 joints  94 numbers agree\n"
              "1 claim: 1 mixed\n");
    EXPECT_NE(claims_table({verdict_on(20, 20)}, 100, true).find("\033[32m"), std::string::npos) << "green";
}

TEST(ClaimsReport, ALongTextInTheTerminalsTableEndsWithAnEllipsis)
{
    Verdict verdict = verdict_on(20, 20);
    verdict.claim.headline = "thirty letters of some text abc {held}";
    const std::string table =
        claims_table({verdict}, 60, false, {.heading = "here", .texts = {{"X01", "94 numbers agree with it"}}});
    EXPECT_NE(table.find("94 numbers agr\u2026"), std::string::npos) << table;
    EXPECT_NE(table.find("thirty lette\u2026"), std::string::npos) << table;
    verdict.claim.headline = "of {held of nothing}";
    EXPECT_NE(claims_table({verdict}, 60, false).find("X01  it holds            HOLDS\n"), std::string::npos)
        << "nothing was measured";
}

TEST(ClaimsReport, TheTerminalsTableNamesWhatIsMissingOnceBelowTheClaims)
{
    Verdict one = verdict_on(20, 20), other = verdict_on(20, 20);
    one.claim.id = "X00";
    for (Verdict* verdict : {&one, &other})
        verdict->left_out = {{"lady", "lady is not installed"}}, verdict->missing = {"walk"};
    const std::string table = claims_table({one, other}, 100, false);
    EXPECT_NE(table.find("excluded from X00, X01: lady is not installed\nno record for X00, X01: walk\n2 claims"),
              std::string::npos)
        << table;
    EXPECT_EQ(table.find("walk"), table.rfind("walk"));
}

}  // namespace
}  // namespace verdict_tests

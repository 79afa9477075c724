// The choice of settings, the diagrams and the decisions on their points. Reference: the rules in diagram.hpp and point_row.hpp, by hand on
// a few points.
#include "experiments/studies/work_precision/diagram.hpp"

#include "experiments/deformers/registry.hpp"
#include "experiments/studies/study.hpp"
#include "tests/support/comparison_records.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

namespace {

using namespace test_support;
using namespace experiments;

const SettingKey packed_pbs = {.deformer = "pbs", .iterations = 24, .precision = "f32", .packed = true};

SettingKey tuned(SettingKey key, const std::string& setting)
{
    key.tuned = setting;
    return key;
}

// In the order of the cases.
TEST(CaseSplit, AlternatesWithinEachBodyAndOnlyEvaluatesALonePose)
{
    std::map<std::string, std::vector<std::string>> halves;
    const nlohmann::json document = cases_document("work_precision");
    for (const nlohmann::json& one : document.at("case"))
        for (const std::string body : one.at("bodies")) halves[body].push_back(one.at("half"));
    EXPECT_EQ(halves.size(), 5u);
    for (const auto& [body, of] : halves)
        for (std::size_t i = 0; i < of.size(); ++i)
            EXPECT_EQ(of[i], of.size() > 1 && i % 2 == 0 ? "training" : "evaluation") << body << " " << i;
}

// The geometric means of a are 20 (10 and 40), of b 16 (32 and 8), although b is worse in the first pose and in the evaluated one.
TEST(ChosenSettings, HaveTheLeastGeometricMeanOverTheTrainingPoses)
{
    const SettingKey a = tuned(packed_pbs, "a"), b = tuned(packed_pbs, "b");
    const CaseRows one = hand_case({.body = "limb", .pose = "one"}, {{a, 1.0, 10.0}, {b, 1.0, 32.0}}, Half::training);
    const CaseRows two = hand_case({.body = "limb", .pose = "two"}, {{a, 1.0, 40.0}, {b, 1.0, 8.0}}, Half::training);
    const CaseRows shown = hand_case({.body = "limb", .pose = "three"}, {{a, 1.0, 1.0}, {b, 1.0, 99.0}});
    const std::vector<ChosenSetting> chosen = choose_settings({one, shown, two});
    ASSERT_EQ(chosen.size(), 1u) << "f32 takes part in packed_f32 alone";
    EXPECT_EQ(chosen[0].key, b);
    EXPECT_EQ(chosen[0].tried, 2);
    EXPECT_EQ(chosen[0].training_poses, 2);
    // Two logarithms, their sum, its half and the exponential, each in error by a rounding of at most log(32).
    EXPECT_NEAR(chosen[0].training_error_joint_pct.value(), 16.0, 16.0 * rounding_error(5, std::log(40.0)));
}

TEST(ChosenSettings, HaveAnAnswerInEachTrainingPose)
{
    const SettingKey a = tuned(packed_pbs, "a"), b = tuned(packed_pbs, "b");
    const CaseRows one = hand_case({.pose = "one"}, {{a, 1.0, 1.0}, {b, 1.0, 50.0}}, Half::training);
    const CaseRows two = hand_case({.pose = "two"}, {{a, 1.0, {}, "not_finite"}, {b, 1.0, 50.0}}, Half::training);
    EXPECT_EQ(choose_settings({one, two}).at(0).key, b);
    const CaseRows none = hand_case({.pose = "two"}, {{a, 1.0, {}, "not_finite"}, {b, 1.0, {}, "not_finite"}}, Half::training);
    EXPECT_TRUE(choose_settings({one, none}).empty());
}

// Iterations are no setting.
TEST(ChosenSettings, OfARungThatNoTrainingPoseHasAreTheDefault)
{
    SettingKey coarse = packed_pbs, more = packed_pbs;
    coarse.wanted_vertices = 600;
    more.iterations = 96;
    EXPECT_EQ(choose_settings({hand_case({.pose = "one"}, {{packed_pbs, 1.0, 10.0}, {more, 4.0, 5.0}}, Half::training)}).size(), 2u);
    const CaseRows training = hand_case({.pose = "one"}, {{packed_pbs, 1.0, 10.0}, {tuned(packed_pbs, "a"), 1.0, 5.0}}, Half::training);
    const CaseRows shown = hand_case({.pose = "two"}, {{coarse, 1.0, 10.0}, {tuned(coarse, "a"), 1.0, 1.0}});
    const std::vector<ChosenSetting> chosen = choose_settings({training, shown});
    ASSERT_EQ(chosen.size(), 2u);
    EXPECT_EQ(chosen[0].key, tuned(packed_pbs, "a"));
    EXPECT_EQ(chosen[1].key, coarse);
    EXPECT_EQ(chosen[1].training_poses, 0);
}

TEST(Comparisons, HaveTheBestCodeOfEachDeformerOrItsPlainOne)
{
    SettingKey plain = packed_pbs, packed_f64 = packed_pbs;
    plain.precision = packed_f64.precision = "f64", plain.packed = false;
    const SettingKey xpbd = {.deformer = "xpbd", .precision = "f64"}, scalar_f32 = {.deformer = "vbd", .precision = "f32"};
    const SettingKey packed_lbs = {.deformer = "lbs", .precision = "f64", .packed = true};
    const BestCodes best = best_codes({hand_case({.pose = "one"}, {{plain, 5.0, 1.0},
                                                                   {packed_pbs, 1.0, 1.0},
                                                                   {packed_f64, 2.0, 1.0},
                                                                   {xpbd, 0.1, 9.0},
                                                                   {packed_lbs, 0.1, 9.0},
                                                                   {scalar_f32, 1.0, 2.0},
                                                                   hand_reference()})});
    EXPECT_EQ(best, (BestCodes{{"pbs", 3}, {"vbd", 2}, {"lbs", 1}, {"xpbd", 0}}));
    const std::vector<SettingKey> all = {plain, packed_pbs, packed_f64, xpbd, packed_lbs, scalar_f32};
    const auto those_in = [&](Comparison comparison) {
        std::vector<SettingKey> keys;
        for (const SettingKey& key : all)
            if (takes_part(comparison, key, best)) keys.push_back(key);
        return keys;
    };
    EXPECT_EQ(those_in(Comparison::packed_f32), (std::vector{packed_pbs, xpbd, packed_lbs, scalar_f32}));
    EXPECT_EQ(those_in(Comparison::plain_f64), (std::vector{plain, xpbd}));
}

// Each deformer that can be compared has at most one code in either comparison, and those with two codes are in both.
TEST(Comparisons, HaveEachDeformerOnce)
{
    CaseRows rows;
    for (const Setting& setting : settings_of(read_scene("limb_twist", {}), {.in_short = true, .quadratic = false}))
        rows.push_back({.key = key_of(setting), .outcome = "finished"});
    const BestCodes best = best_codes({rows});
    for (const Comparison comparison : comparisons) {
        std::set<std::string> deformers;
        std::set<SettingKey> without_code;
        for (const PointRow& row : rows) {
            if (!takes_part(comparison, row.key, best)) continue;
            SettingKey key = row.key;
            key.precision = key.order = "", key.packed = false;
            EXPECT_TRUE(without_code.insert(key).second)
                << row.key.deformer << " is in " << analysis::recorded_name(comparison) << " in two codes";
            deformers.insert(key.deformer);
        }
        for (const char* name : {"lbs", "lbs_diffused", "dqs", "dqs_diffused", "delta_mush", "pbs", "xpbd", "quasi_newton", "vbd"})
            EXPECT_TRUE(deformers.contains(name)) << name << ", " << analysis::recorded_name(comparison);
    }
}

std::vector<std::string> keys_of(const std::vector<Diagram>& diagrams, Comparison comparison)
{
    std::vector<std::string> keys;
    for (const Diagram& one : diagrams)
        if (one.comparison == comparison) keys.push_back(one.key);
    return keys;
}

const Diagram& of_key(const std::vector<Diagram>& diagrams, const std::string& key)
{
    return *std::ranges::find(diagrams, key, &Diagram::key);
}

TEST(Diagram, HoldsThePointsWithTimeAndErrorAndTheReferenceBeside)
{
    std::vector<HandPoint> unreached = seven_points(30.0);
    for (HandPoint& row : unreached) row.error_pct.reset();
    unreached.back().outcome = "not_reached";
    EXPECT_TRUE(hand_diagrams({hand_case(bent_limb, unreached)}).front().points.empty());
    const Diagram read = diagram_of_seven(30.0);
    EXPECT_EQ(read.key, "limb_bend_90");
    EXPECT_EQ(read.points.size(), 7u);
    EXPECT_TRUE(read.has_reference);
    EXPECT_EQ(read.reference_error_pct, 6.0);
}

TEST(Diagram, ThereIsOneForEachComparison)
{
    SettingKey packed = pbs_24;
    packed.precision = "f32", packed.packed = true;
    const std::vector<Diagram> both =
        hand_diagrams({hand_case(bent_limb, {{in_f64({"lbs"}), 0.01, 60.0}, {pbs_24, 5.0, 20.0}, {packed, 0.7, 20.0}, hand_reference()})});
    ASSERT_EQ(both.size(), 2u);
    EXPECT_EQ(both[0].comparison, Comparison::packed_f32);
    EXPECT_EQ(both[0].points.at(1).ms, 0.7);
    EXPECT_EQ(both[1].comparison, Comparison::plain_f64);
    EXPECT_EQ(both[1].points.at(1).ms, 5.0);
    for (const Diagram& one : both) EXPECT_EQ(one.points.at(0).key.deformer, "lbs");
}

TEST(Diagram, AMeanTakesTheEvaluatedPosesAndTheSettingsThatAllOfThemHave)
{
    std::vector<HandPoint> without = seven_points(24.0);
    without.erase(without.begin() + 1);  // no DQS
    const std::vector<Diagram> diagrams = hand_diagrams(
        {hand_case({.body = "limb", .pose = "a"}, seven_points(30.0)), hand_case({.body = "man", .pose = "b"}, seven_points(36.0)),
         hand_case({.body = "limb", .pose = "t"}, seven_points(99.0), Half::training), hand_case({.body = "limb", .pose = "c"}, without)});
    EXPECT_EQ(keys_of(diagrams, Comparison::packed_f32),
              (std::vector<std::string>{"limb_a", "man_b", "limb_t", "limb_c", "mean_of_3_evaluated_poses"}));
    const Diagram& mean = of_key(diagrams, "mean_of_3_evaluated_poses");
    EXPECT_EQ(mean.points.size(), 6u);
    EXPECT_NEAR(mean.points[1].error_pct, 30.0, mean_error(3, 30.0));
    EXPECT_NEAR(mean.points[1].ms, 0.5, mean_error(3, 0.5));
    EXPECT_EQ(mean.poses, 3);
}

TEST(Diagram, AMeanHasTheFurtherReferencesThatAllPosesHave)
{
    std::vector<CaseRecords> cases = {{hand_case({.body = "limb", .pose = "a"}, seven_points(30.0))},
                                      {hand_case({.body = "limb", .pose = "b"}, seven_points(30.0))}};
    const auto member = [](const std::string& name, double bound_pct) {
        FamilyRow row;
        row.member.name = name;
        row.outcome = "reached";
        row.error_bound_pct = bound_pct;
        return row;
    };
    cases[0].members = {member("stiffer_springs", 1.0), member("nu_0.3", 2.0)};
    cases[1].members = {member("stiffer_springs", 3.0)};
    cases[0].rows[3].members[0] = 8.0, cases[1].rows[3].members[0] = 10.0;
    const std::vector<Diagram> diagrams = diagrams_of(cases, choose_settings({cases[0].rows, cases[1].rows}));
    const Diagram& mean = of_key(diagrams, "mean_of_2_evaluated_poses");
    EXPECT_TRUE(mean.members[0].takes_part);
    EXPECT_NEAR(mean.members[0].bound_pct.value(), 2.0, mean_error(2, 3.0));
    EXPECT_FALSE(mean.members[3].takes_part);
    EXPECT_NEAR(mean.points[3].members[0].value(), 9.0, mean_error(2, 10.0));
    EXPECT_FALSE(mean.points[2].members[0]);
}

// PBS has an error of 20 %; the reference's own error is at most 6 %.
Diagram two_points(double mush_pct)
{
    return hand_diagrams({hand_case({.body = "limb", .pose = "a"},
                                    {{in_f64({"delta_mush", 20}), 0.5, mush_pct}, {pbs_24, 0.7, 20.0}, hand_reference()})})
        .front();
}

// A further reference: its bound, and the errors of PBS and delta mush. Nothing: it was not reached.
struct Further {
    std::size_t place;
    std::optional<double> bound_pct = {}, pbs_pct = {}, mush_pct = {};
};

struct DecidedCase {
    double mush_pct;
    std::vector<Further> further;
    analysis::PairDecision decision;
    bool knows_the_bound = true;
};

class Decisions : public testing::TestWithParam<DecidedCase> {};

TEST_P(Decisions, NeedADifferenceOfMoreThanTwiceTheBoundForEachReference)
{
    Diagram of = two_points(GetParam().mush_pct);
    if (!GetParam().knows_the_bound) of.reference_error_pct.reset();
    for (const Further& one : GetParam().further) {
        of.members[one.place] = {true, one.bound_pct};
        of.points[1].members[one.place] = one.pbs_pct;
        of.points[0].members[one.place] = one.mush_pct;
    }
    std::vector<analysis::PairOrder> orders;
    for (const ReferenceOrder& one : orders_on(of, of.points[1], of.points[0])) orders.push_back(one.order);
    EXPECT_EQ(orders.size(), 1 + GetParam().further.size());
    EXPECT_EQ(analysis::decide(orders), GetParam().decision);
}

using enum analysis::PairDecision;
INSTANTIATE_TEST_SUITE_P(
    OfTwoPoints, Decisions,
    testing::Values(DecidedCase{33.0, {}, decided},  // 33 - 20 > 2 x 6
                    DecidedCase{31.0, {}, reference_error}, DecidedCase{33.0, {}, reference_error, false},
                    DecidedCase{33.0, {{0, 1.0, 10.0, 13.0}, {1, 2.0, 10.0, 15.0}}, decided},
                    DecidedCase{33.0, {{0, 1.0, 10.0, 13.0}, {1, 3.0, 10.0, 15.0}}, reference_error},  // 15 - 10 < 2 x 3
                    DecidedCase{33.0, {{0, 1.0, 13.0, 10.0}}, models_disagree}, DecidedCase{33.0, {{4}}, reference_error}));  // not reached

}  // namespace

// The split of the poses and the choice of settings. Reference: the rules in point_row.hpp and diagram.hpp, by hand.
#include "experiments/studies/work_precision/diagram.hpp"

#include "tests/support/comparison_records.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <set>

namespace {

using namespace experiments;
using test_support::hand_case;
using test_support::HandPoint;

const SettingKey packed_pbs = {.deformer = "pbs", .iterations = 24, .precision = "f32", .packed = true};

SettingKey tuned(SettingKey key, const std::string& setting)
{
    key.tuned = setting;
    return key;
}

TEST(CaseSplit, AlternatesWithinEachBodyAndOnlyEvaluatesALonePose)
{
    using enum Half;
    EXPECT_EQ(halves_of({"limb", "limb", "limb", "limb"}), (std::vector{training, evaluation, training, evaluation}));
    EXPECT_EQ(halves_of({"limb", "human", "limb", "human", "man", "human"}),
              (std::vector{training, training, evaluation, evaluation, evaluation, training}));
    EXPECT_TRUE(halves_of({}).empty());
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
    EXPECT_NEAR(chosen[0].training_error_pct.value(), 16.0, 16.0 * test_support::rounding_error(5, std::log(40.0)));
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

TEST(ChosenSettings, OfARungThatNoTrainingPoseHasAreTheDefault)
{
    SettingKey coarse = packed_pbs;
    coarse.wanted_vertices = 600;
    const CaseRows training = hand_case({.pose = "one"}, {{packed_pbs, 1.0, 10.0}, {tuned(packed_pbs, "a"), 1.0, 5.0}}, Half::training);
    const CaseRows shown = hand_case({.pose = "two"}, {{coarse, 1.0, 10.0}, {tuned(coarse, "a"), 1.0, 1.0}});
    const std::vector<ChosenSetting> chosen = choose_settings({training, shown});
    ASSERT_EQ(chosen.size(), 2u);
    EXPECT_EQ(chosen[0].key, tuned(packed_pbs, "a"));
    EXPECT_EQ(chosen[1].key, coarse);
    EXPECT_EQ(chosen[1].training_poses, 0);
}

TEST(ChosenSettings, IterationsAreNoSetting)
{
    SettingKey more = packed_pbs;
    more.iterations = 96;
    const CaseRows training = hand_case({.pose = "one"}, {{packed_pbs, 1.0, 10.0}, {more, 4.0, 5.0}}, Half::training);
    EXPECT_EQ(choose_settings({training}).size(), 2u);
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
                                                                   test_support::hand_reference()})});
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
    for (const PointSetting& setting : point_settings(read_scene("limb_twist", {}), {.in_short = true, .quadratic = false}))
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
                << text_of(row.key) << " is in " << analysis::recorded_name(comparison) << " in two codes";
            deformers.insert(key.deformer);
        }
        for (const char* name : {"lbs", "lbs_diffused", "dqs", "dqs_diffused", "delta_mush", "pbs", "xpbd", "quasi_newton", "vbd"})
            EXPECT_TRUE(deformers.contains(name)) << name << ", " << analysis::recorded_name(comparison);
    }
}

}  // namespace

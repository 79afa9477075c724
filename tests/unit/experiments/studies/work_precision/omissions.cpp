// Reference: the list of reasons in diagram_tables.hpp, by hand.
#include "experiments/studies/work_precision/diagram_tables.hpp"

#include "tests/support/comparison_records.hpp"

#include <gtest/gtest.h>

namespace {

using namespace experiments;
using test_support::hand_case;
using test_support::hand_reference;
using test_support::HandPoint;

using Found = std::tuple<Comparison, std::string, std::string, std::string, int, int>;

std::vector<Found> found_in(const std::vector<CaseRows>& cases)
{
    std::vector<Found> found;
    for (const Omission& one : omissions_of(cases))
        found.emplace_back(one.comparison, one.of, one.deformer, one.why, one.missing, one.points);
    return found;
}

TEST(Omissions, NameEachReasonWithItsPoints)
{
    const auto vbd = [](int iterations) { return SettingKey{.deformer = "vbd", .iterations = iterations, .precision = "f32"}; };
    const SettingKey lbs = {.deformer = "lbs", .precision = "f64"}, fem = {.deformer = "fem_linear", .precision = "f64"};
    CaseRows first = hand_case({.body = "limb", .pose = "a"}, {{lbs, 0.1, 9.0},
                                                               {vbd(1), 1.0, 9.0},
                                                               {vbd(4), 4.0, {}, "not_finite"},
                                                               {vbd(8), 8.0, {}, "over_time_limit"},
                                                               {vbd(16), 16.0, {}, "over_time_limit"},
                                                               {fem, 9.0, {}, "not_converged"},
                                                               hand_reference()});
    first[3].reason = "900 ms on the rung before, 300 ms allowed";
    const CaseRows second = hand_case({.body = "limb", .pose = "b"}, {{vbd(1), 1.0, 9.0}, hand_reference()});
    const std::vector<Found> expected = {{Comparison::packed_f32, "limb_a", "vbd", "not_finite", 1, 4},
                                         {Comparison::packed_f32, "limb_a", "vbd", "over_time_limit", 2, 4},
                                         {Comparison::packed_f32, "limb_a", "fem_linear", "not_converged", 1, 1},
                                         {Comparison::packed_f32, "limb_b", "lbs", "not_run", 0, 0},
                                         {Comparison::packed_f32, "limb_b", "fem_linear", "not_run", 0, 0},
                                         {Comparison::plain_f64, "limb_a", "vbd", "no_such_code", 0, 0},
                                         {Comparison::plain_f64, "limb_a", "fem_linear", "not_converged", 1, 1},
                                         {Comparison::plain_f64, "limb_b", "lbs", "not_run", 0, 0},
                                         {Comparison::plain_f64, "limb_b", "vbd", "no_such_code", 0, 0},
                                         {Comparison::plain_f64, "limb_b", "fem_linear", "not_run", 0, 0}};
    EXPECT_EQ(found_in({first, second}), expected);
    EXPECT_EQ(omissions_of({first})[1].reason, "900 ms on the rung before, 300 ms allowed");
}

TEST(Omissions, NameAPoseWithoutAReference)
{
    CaseRows rows = hand_case({.body = "limb", .pose = "a"}, {{{.deformer = "lbs", .precision = "f64"}, 0.1, {}}, hand_reference()});
    rows.back().outcome = "not_reached";
    rows.back().reason = "worst tet 7 of volume ratio -0.1, 1 inverted";
    EXPECT_EQ(found_in({rows}).front(), Found(Comparison::packed_f32, "limb_a", "lbs", "no_reference", 1, 1));
    EXPECT_EQ(omissions_of({rows}).front().reason, "worst tet 7 of volume ratio -0.1, 1 inverted");
}

// In both poses a point of vbd diverges, and in the second one LBS is not run. The training pose is not part of the mean.
TEST(Omissions, OfAMeanAreThoseOfItsPoses)
{
    const SettingKey lbs = {.deformer = "lbs", .precision = "f64"}, vbd = {.deformer = "vbd", .iterations = 1, .precision = "f64"};
    SettingKey more = vbd;
    more.iterations = 4;
    const HandPoint diverged = {more, 4.0, {}, "not_finite"};
    const std::vector<CaseRows> cases = {
        hand_case({.body = "limb", .pose = "a"}, {{lbs, 0.1, 9.0}, {vbd, 1.0, 9.0}, diverged, hand_reference()}),
        hand_case({.body = "limb", .pose = "b"}, {{vbd, 1.0, 9.0}, diverged, hand_reference()}),
        hand_case({.body = "limb", .pose = "c"}, {{vbd, 1.0, 9.0}, diverged, hand_reference()}, Half::training)};
    std::vector<Found> found;
    for (const Omission& one : omissions_of_means(cases, test_support::hand_diagrams(cases)))
        found.emplace_back(one.comparison, one.of, one.deformer, one.why, one.missing, one.points);
    const std::string mean = "mean_of_2_evaluated_poses";
    const std::vector<Found> expected = {{Comparison::packed_f32, mean, "vbd", "not_finite", 2, 4},
                                         {Comparison::packed_f32, mean, "lbs", "not_run", 0, 1},
                                         {Comparison::plain_f64, mean, "vbd", "not_finite", 2, 4},
                                         {Comparison::plain_f64, mean, "lbs", "not_run", 0, 1}};
    EXPECT_EQ(found, expected);
}

// A point of vbd diverges in one of four poses, in each of which it has two points.
TEST(Omissions, OfAMeanCountThePointsOfPosesWithoutAnOmission)
{
    const auto vbd = [](int iterations) { return SettingKey{.deformer = "vbd", .iterations = iterations, .precision = "f64"}; };
    std::vector<CaseRows> cases;
    for (const char* pose : {"a", "b", "c", "d"})
        cases.push_back(hand_case({.body = "limb", .pose = pose}, {{vbd(1), 1.0, 9.0}, {vbd(4), 4.0, 9.0}, hand_reference()}));
    cases[1] = hand_case({.body = "limb", .pose = "b"}, {{vbd(1), 1.0, 9.0}, {vbd(4), 4.0, {}, "not_finite"}, hand_reference()});
    const std::vector<Omission> of_means = omissions_of_means(cases, test_support::hand_diagrams(cases));
    ASSERT_FALSE(of_means.empty());
    for (const Omission& one : of_means) EXPECT_EQ(std::tuple(one.why, one.missing, one.points), std::tuple("not_finite", 1, 8)) << one.of;
}

TEST(Omissions, AreNoneWhereEachPointHasATimeAndAnError)
{
    EXPECT_TRUE(omissions_of({hand_case({.pose = "a"}, {{{.deformer = "lbs", .precision = "f64"}, 0.1, 5.0}, hand_reference()})}).empty());
}

}  // namespace

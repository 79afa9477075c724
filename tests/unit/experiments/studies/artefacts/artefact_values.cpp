// The values of C04 and C05 from invented sections of a small limb. Reference: the ratios of the given sizes.

#include "experiments/characters/bodies.hpp"
#include "experiments/studies/artefacts/artefact_values.hpp"
#include "tests/support/artefact_samples.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace {

using namespace experiments;
using test_support::sample;

std::vector<analysis::Measurement> of_quantity(const std::vector<analysis::Measurement>& measurements,
                                               const std::string& quantity, const std::string& deformer)
{
    std::vector<analysis::Measurement> chosen;
    for (const auto& measurement : measurements)
        if (measurement.quantity == quantity && measurement.of.deformer == deformer) chosen.push_back(measurement);
    return chosen;
}

class BulgeFigures : public testing::Test {
protected:
    std::vector<analysis::Measurement> measurements(const std::string& deformer = "pbs") const
    {
        return of_quantity(section_values(of, body, samples), "largest_section_radius_over_reference", deformer);
    }
    SectionOutcome outcome(std::size_t pose) const { return section_outcomes(of, body, samples)[pose].outcome; }
    std::string remark(std::size_t pose) const { return section_outcomes(of, body, samples)[pose].remark; }

    ArtefactCase of = test_support::small_limb(ArtefactCase::Claim::bulge);
    ArtefactBody body{of};
    std::vector<ArtefactSample> samples;
};

// Quadratic elements count wherever they come among the samples, and linear ones where there are no others.
TEST_F(BulgeFigures, AreOverTheReferenceOfTheHighestOrder)
{
    const auto expect_values = [&](double value, double low, double high, const std::string& of) {
        ASSERT_EQ(measurements().size(), 1u);
        EXPECT_DOUBLE_EQ(measurements()[0].value, value);
        EXPECT_DOUBLE_EQ(measurements()[0].low, low);
        EXPECT_DOUBLE_EQ(measurements()[0].high, high);
        EXPECT_EQ(text_of(measurements()[0].of), "limb, bend, upper|forearm, " + of);
    };
    samples = {sample("pbs", 0, 1.2), sample("reference", 0, 1.0, 1), sample("reference", 0, 1.5, 2),
               sample("reference", 0, 0.8, 1)};
    expect_values(1.2 / 1.5, 1.2 / 1.5, 1.2 / 0.8,
                  "30 deg, pbs, reference nh_p2, plain, f64");  // relative to the largest and the smallest reference
    samples = {sample("pbs", 1, 1.1), sample("pbs", 1, 1.3), sample("reference", 1, 1.0, 1)};
    expect_values(1.1, 1.1, 1.3, "90 deg, pbs, reference nh_p1, plain, f64");
}

TEST_F(BulgeFigures, StateWhySectionsAreLeftOut)
{
    using enum SectionOutcome;
    const std::string wide = "reference 3.1 times as wide as at rest, 100 % of that outline the limb's own skin";
    struct Row {
        const char* name;
        std::vector<ArtefactSample> samples;
        std::size_t of_pbs, of_dqs;
        std::map<std::size_t, SectionOutcome> outcomes;  // by pose
        std::map<std::size_t, std::string> remarks;
    };
    const Row rows[] = {{"no reference",
                         {sample("pbs", 0, 1.0), sample("reference", 0, 1.0, 1), sample("pbs", 1, 1.0)},
                         1,
                         0,
                         {{0, measured}, {1, reference_not_reached}},
                         {}},
                        {"a deep fold, whatever the reference",
                         {sample("pbs", 2, 5.0), sample("reference", 2, 1.0, 1)},
                         0,
                         0,
                         {{2, bent_too_far}},
                         {{2, ""}}},
                        {"a part that the reference has gone into",
                         {sample("pbs", 0, 1.0), sample("reference", 0, 1.0, 1), sample("reference", 0, 3.1, 1),
                          sample("dqs", 0, 1.0), sample("pbs", 1, 1.0), sample("reference", 1, 2.9, 1)},
                         1,
                         0,
                         {{0, inside_another_part}, {1, measured}},
                         {{0, wide}, {1, ""}}},
                        {"pbs broke down, and blends are compared",
                         {sample("dqs", 0, 2.0), sample("reference", 0, 1.0, 1)},
                         0,
                         1,
                         {{0, pbs_did_not_finish}},
                         {}}};
    for (const Row& row : rows) {
        SCOPED_TRACE(row.name);
        samples = row.samples;
        EXPECT_EQ(measurements().size(), row.of_pbs);
        EXPECT_EQ(measurements("dqs").size(), row.of_dqs);
        for (const auto& [pose, expected] : row.outcomes) EXPECT_EQ(outcome(pose), expected);
        for (const auto& [pose, expected] : row.remarks) EXPECT_EQ(remark(pose), expected);
    }
}

// Whatever its width, C05 only denies a bulge of pbs.
TEST_F(BulgeFigures, WhatIsWideUnderPbsOrABlendAloneIsJudgedWithARemark)
{
    samples = {sample("pbs", 0, 1.0), sample("pbs", 0, 3.1), sample("reference", 0, 1.0, 1), sample("dqs", 0, 8.0)};
    samples[1].extremes.limb_share_of_widest = 0.25;
    ASSERT_EQ(measurements().size(), 1u);
    EXPECT_DOUBLE_EQ(measurements()[0].high, 3.1);
    EXPECT_EQ(measurements("dqs").size(), 1u);
    EXPECT_EQ(outcome(0), SectionOutcome::measured);
    EXPECT_EQ(remark(0),
              "pbs 3.1 times as wide as at rest, 25 % of that outline the limb's own skin; "
              "dqs 8 times as wide as at rest, 100 % of that outline the limb's own skin");
    EXPECT_EQ(section_rows(of, body, section_outcomes(of, body, samples)).at(0).remark, remark(0));
}

// A movement of other joints has no section here, and one of the forearm has.
TEST_F(BulgeFigures, OfAMovementOnlyTheJointsThatItTurnsAreLookedAt)
{
    samples = {sample("pbs", 0, 1.2), sample("reference", 0, 1.0, 1)};
    of.poses[0].turned = {"hand"};
    EXPECT_TRUE(measurements().empty());
    EXPECT_EQ(section_outcomes(of, body, samples).size(), of.poses.size() - 1);
    of.poses[0].turned = {"hand", "forearm"};
    EXPECT_EQ(measurements().size(), 1u);
    for (ArtefactPose& pose : of.poses) pose.turned = {"hand"};
    const ArtefactRecords records = find_artefacts(of, body);
    EXPECT_TRUE(records.samples.empty() && records.profiles.empty());
    EXPECT_FALSE(records.intersections.empty());
}

TEST_F(BulgeFigures, TableHasALineASectionWithItsOutcome)
{
    samples = {sample("pbs", 0, 1.0), sample("reference", 0, 1.0, 2), sample("pbs", 1, 1.0)};
    std::vector<std::string> outcomes;
    for (const auto& row : section_rows(of, body, section_outcomes(of, body, samples)))
        outcomes.push_back(row.reference + " " + row.outcome);
    EXPECT_EQ(outcomes,
              (std::vector<std::string>{"nh_p2 measured", " reference_not_reached", " bent_by_more_than_110_deg"}));
}

TEST(SectionTable, SaysWhyAJointHasNoSection)
{
    if (!pbs::body_is_installed("frankie")) GTEST_SKIP() << "pbskin fetch frankie";
    ArtefactCase of;
    of.scene = read_scene("limb_bend", {"character.body=frankie", "motion.joint=shin.L", "motion.frames=2"});
    of.poses = {{1, "bend_90_deg"}};
    const ArtefactBody body(of);
    const auto rows = section_rows(of, body, section_outcomes(of, body, {}));
    ASSERT_EQ(rows.size(), body.joints.size() + 1);
    EXPECT_EQ(rows.back().joint, "thigh.L|shin.L");
    EXPECT_EQ(rows.back().outcome, "leg_drawn_into_the_belly");
    of.joint = "tail_1|tail_2";
    const ArtefactBody tail(of);
    EXPECT_EQ(section_rows(of, tail, section_outcomes(of, tail, {})).size(), 1u);
}

// One row per order and precision, whose range is that of its meshes. The reference has a row of its own.
TEST(CandyWrapperFigures, AreThoseOfTheOwnMeshInEachOrderAndDoWithoutTheReference)
{
    const ArtefactCase of = test_support::small_limb(ArtefactCase::Claim::candy_wrapper);
    const ArtefactBody body(of);
    const std::vector<ArtefactSample> samples = {sample("pbs", 0, 0.95),      sample("pbs", 0, 0.8, 0, "ordered"),
                                                 sample("pbs", 0, 0.85),      sample("lbs", 0, 0.1),
                                                 sample("reference", 0, 1.1), sample("pbs", 2, 0.9)};
    const auto measurements = section_values(of, body, samples);
    const auto own = of_quantity(measurements, "smallest_section_radius_over_rest", "pbs");
    ASSERT_EQ(own.size(), 3u);
    EXPECT_EQ(own[0].value, 0.8);
    EXPECT_EQ(text_of(own[0].of), "limb, bend, upper|forearm, 30 deg, pbs, ordered, f64");
    EXPECT_EQ(own[1].value, 0.95);
    EXPECT_EQ(own[1].low, 0.85);
    EXPECT_EQ(text_of(own[1].of), "limb, bend, upper|forearm, 30 deg, pbs, plain, f64");
    EXPECT_EQ(of_quantity(measurements, "smallest_section_radius_over_rest", "lbs").size(), 1u);
    EXPECT_EQ(of_quantity(measurements, "smallest_section_radius_over_rest", "reference").at(0).value, 1.1);
    const auto outcomes = section_outcomes(of, body, samples);
    EXPECT_EQ(outcomes[1].outcome, SectionOutcome::pbs_did_not_finish);
    EXPECT_EQ(outcomes[2].outcome, SectionOutcome::measured);  // bent, which has no effect here
}

// Two iterations do not reach a tolerance of 1e-12.
TEST(ArtefactBreakdown, NamesThePoseTheMeshAndTheWorstTet)
{
    ArtefactCase of;
    of.scene = read_scene("limb_bend", {"character.vertices=400", "motion.frames=2", "pbs.iterations=2",
                                        "pbs.stop_residual=1e-12", R"(deformers.use=["pbs"])", R"(reference.name="")"});
    of.poses.push_back({1, "bend_150_deg", {.motion = "bend", .angle_deg = 150.0}});
    const ArtefactBody body(of);
    const std::string breakdown = find_artefacts(of, body).breakdown;
    const std::string place =
        "pbs did not reach bend_150_deg on " + std::to_string(body.posed.character().mesh.rest.rows()) + " vertices: ";
    EXPECT_TRUE(breakdown.starts_with(place + "worst tet ")) << breakdown;
    EXPECT_NE(breakdown.find(" of volume ratio "), std::string::npos) << breakdown;
    EXPECT_NE(breakdown.find(" inverted. "), std::string::npos) << breakdown;
}

// A deformer that remembers its last frame would take the pose before for it.
TEST(ArtefactPoses, AreReachedFromRestByADeformerWithMemory)
{
    const Scene scene = read_scene("limb_bend", {"character.vertices=400", "motion.frames=6",
                                                 R"(deformers.use=["pbs_author"])", R"(reference.name="")"});
    const auto shapes = [&](const std::vector<int>& frames) {
        return PosedCharacter(scene, frames).shapes(spec_of(scene, "pbs_author"));
    };
    EXPECT_EQ(shapes({1, 3}).at(1).positions, shapes({3}).at(0).positions);
}

// Reference: the sections of the shapes that PBS takes step by step. If each of its frames begins with the one before,
// these are other shapes than those from rest.
TEST(ArtefactPoses, AreReachedThroughTheSweepWhereTheCaseAsksForIt)
{
    ArtefactCase twisted;
    twisted.scene = read_scene(
        "limb_twist", {"character.vertices=400", "motion.angle_deg=90", "motion.frames=4",
                       R"(deformers.use=["lbs","pbs"])", "reference.name=lbs", "pbs.variant.lbs_entry=increment"});
    twisted.poses = {{.frame = 3, .name = "twist_90_deg"}};
    twisted.joint = "upper|forearm";
    twisted.claim = ArtefactCase::Claim::candy_wrapper;
    twisted.through_sweep = true;
    const ArtefactBody body(twisted);
    const auto narrowest = [&] {
        const ArtefactRecords records = find_artefacts(twisted, body);
        return std::ranges::find(records.samples, "pbs", &ArtefactSample::group)->extremes.smallest_radius;
    };
    const pbs::Character& limb = body.posed.character();
    const pbs::Motion sweep = make_motion(twisted.scene.motion, limb.skeleton, twisted.scene.file);
    const pbs::Positions last = shapes_in_motion(limb, sweep, spec_of(twisted.scene, "pbs")).at(3);
    EXPECT_EQ(narrowest(), extremes_of(body.sections.at(0).measure(last, body.posed.pose(0))).smallest_radius);
    const ArtefactRecords records = find_artefacts(twisted, body);
    EXPECT_EQ(records.samples.size(), 2u) << "lbs, and pbs in the order and precision of the scene";
    EXPECT_TRUE(records.intersections.empty());
    const double through_sweep = narrowest();
    twisted.through_sweep = false;
    EXPECT_NE(narrowest(), through_sweep);
}

// The weights of Eq. 2 compared with rigid ones on a small limb. Reference: the records whose ratios are the values;
// with rigid weights one layer of tets takes all of a twist; without a pose there is no roughness.

WeightsComparison compared(const std::vector<ArtefactPose>& poses)
{
    auto of = test_support::small_limb(ArtefactCase::Claim::bulge);
    of.poses = poses;
    return compare_weights(of);
}

const analysis::Measurement* measurement(const WeightsComparison& comparison, const std::string& quantity,
                                         const std::string& deformer)
{
    for (const auto& one : comparison.measurements)
        if (one.quantity == quantity && one.of.deformer == deformer) return &one;
    return nullptr;
}

double strain_jump(const WeightsComparison& comparison, const std::string& weights, const analysis::CaseKey& of)
{
    for (const SmoothnessRow& row : comparison.smoothness)
        if (row.weights == weights && row.deformer.deformer == of.deformer && row.deformer.order == of.order &&
            row.deformer.precision == of.precision)
            return row.smoothness.strain_jump_rms;
    return -1.0;
}

TEST(WeightsComparison, FiguresAreTheRatiosOfTheRecords)
{
    const WeightsComparison bent = compared({{2, "bend_60_deg", {.motion = "bend", .angle_deg = 60.0}}});
    std::map<std::string, std::string> weights = {
        {"default", "paper"}, {"exchanged_weights", "exchanged"}, {"diffused_weights", "diffused"}};
    std::map<std::string, int> rows;  // by variant
    for (const auto& one : bent.measurements) {
        if (one.quantity != "strain_jump_over_rigid_weights") continue;
        EXPECT_DOUBLE_EQ(one.value,
                         strain_jump(bent, weights.at(one.of.variant), one.of) / strain_jump(bent, "rigid", one.of));
        EXPECT_TRUE(text_of(one.of).starts_with("limb, bend, upper|forearm, 60 deg, " + one.of.deformer))
            << text_of(one.of);
        ++rows[one.of.variant];
    }
    EXPECT_EQ(rows, (std::map<std::string, int>{{"default", 5}, {"exchanged_weights", 2}, {"diffused_weights", 2}}));
}

// On tets that are smaller than the region blended by Eq. 2.
TEST(WeightsComparison, RigidBlendingShearsOneLayerInATwistWhatEquation2SpreadsOverMany)
{
    auto of = test_support::small_limb(ArtefactCase::Claim::candy_wrapper);
    of.scene.character.vertices = 1200;
    of.scene.motion.axis = pbs::Vec3::UnitX();
    of.poses = {{3, "twist_90_deg"}};
    const WeightsComparison twisted = compare_weights(of);
    EXPECT_LT(measurement(twisted, "strain_jump_over_rigid_weights", "lbs")->value, 0.8);
}

TEST(WeightsComparison, AtRestThereIsNothingToCompare)
{
    const WeightsComparison rest = compared({{0, "rest"}});
    EXPECT_EQ(measurement(rest, "strain_jump_over_rigid_weights", "lbs"), nullptr);  // a ratio of roundings
    // A gradient is edges, of two positions that are blended from two motions, times the inverse of edges at rest;
    // strains differ by as much as gradients do, a jump twice.
    const auto worst = test_support::worst_magnification(pbs::make_character({.body = "limb", .vertices = 400}).mesh);
    const double of_gradient = 2.0 * std::sqrt(3.0) * test_support::motion_error(2, 1.15) * worst.inverse_edges +
                               test_support::rounding_error(12 + 3, worst.condition);
    EXPECT_LT(strain_jump(rest, "rigid", {.deformer = "lbs"}), 2.0 * std::sqrt(3.0) * of_gradient);
}

}  // namespace

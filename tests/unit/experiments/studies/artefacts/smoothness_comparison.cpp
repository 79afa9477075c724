// The weights of Eq. 2 compared with rigid ones on a small limb. Reference: the records whose ratios are the values; with rigid weights one
// layer of tets takes all of a twist; without a pose there is no roughness; weights do not change the limit of the solver.
#include "experiments/studies/artefacts/smoothness_comparison.hpp"

#include "pbs/character/bodies.hpp"
#include "tests/support/artefact_samples.hpp"
#include "tests/support/motion_rounding.hpp"
#include "tests/support/tet_rounding.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

using experiments::WeightsComparison;

WeightsComparison compared(const std::vector<experiments::ArtefactPose>& poses)
{
    auto of = test_support::small_limb(experiments::ArtefactCase::Claim::bulge);
    of.poses = poses;
    return experiments::compare_weights(of);
}

const analysis::Measurement* measurement(const WeightsComparison& comparison, const std::string& quantity,
                                         const std::string& deformer = "pbs")
{
    for (const auto& one : comparison.measurements)
        if (one.quantity == quantity && one.of.deformer == deformer) return &one;
    return nullptr;
}

double strain_jump(const WeightsComparison& comparison, const std::string& weights, const std::string& deformer)
{
    for (const experiments::SmoothnessRow& row : comparison.smoothness)
        if (row.weights == weights && row.deformer.deformer == deformer) return row.smoothness.strain_jump_rms;
    return -1.0;
}

TEST(WeightsComparison, FiguresAreTheRatiosOfTheRecords)
{
    const WeightsComparison bent = compared({{2, "bend_60_deg", {.motion = "bend", .angle_deg = 60.0}}});
    for (const std::string deformer : {"lbs", "pbs"}) {
        const auto* jump = measurement(bent, "strain_jump_over_rigid_weights", deformer);
        ASSERT_NE(jump, nullptr);
        EXPECT_DOUBLE_EQ(jump->value, strain_jump(bent, "paper", deformer) / strain_jump(bent, "rigid", deformer));
        EXPECT_LE(jump->low, jump->value);
        EXPECT_GE(jump->high, jump->value);
        EXPECT_EQ(text_of(jump->of), "limb, bend, upper|forearm, 60 deg, " + deformer);
    }
}

// On tets that are smaller than the region blended by Eq. 2.
TEST(WeightsComparison, RigidBlendingShearsOneLayerInATwistWhatEquation2SpreadsOverMany)
{
    auto of = test_support::small_limb(experiments::ArtefactCase::Claim::candy_wrapper);
    of.scene.character.vertices = 1200;
    of.scene.motion.axis = pbs::Vec3::UnitX();
    of.poses = {{3, "twist_90_deg"}};
    const WeightsComparison twisted = experiments::compare_weights(of);
    EXPECT_LT(measurement(twisted, "strain_jump_over_rigid_weights", "lbs")->value, 0.8);
}

// The blend by Eq. 2 is closer to a crease than two rigid halves that penetrate each other.
TEST(WeightsComparison, IterationsAreTheRatioOfTheirRecordAndRigidHalvesTakeMore)
{
    auto of = test_support::small_limb(experiments::ArtefactCase::Claim::bulge);
    of.scene.character.vertices = 1200;
    of.poses = {{3, "bend_90_deg"}};
    const WeightsComparison bent = experiments::compare_weights(of);
    ASSERT_EQ(bent.iterations.size(), 1u);
    const auto* ratio = measurement(bent, "iterations_over_rigid_weights");
    ASSERT_TRUE(bent.iterations[0].paper.within);
    ASSERT_NE(ratio, nullptr);
    EXPECT_LT(ratio->value, 1.0);
    const double paper = std::max(bent.iterations[0].paper.iterations, 1);
    EXPECT_DOUBLE_EQ(ratio->value, paper / std::max(bent.iterations[0].rigid.iterations, 1));
}

TEST(WeightsComparison, AtRestThereIsNothingToCompareButTheSameStart)
{
    const WeightsComparison rest = compared({{0, "rest"}});
    EXPECT_EQ(measurement(rest, "strain_jump_over_rigid_weights", "lbs"), nullptr);  // a ratio of roundings
    // A gradient is edges, of two positions that are blended from two motions, times the inverse of edges at rest; strains differ by as
    // much as gradients do, a jump twice.
    const auto worst = test_support::worst_magnification(pbs::make_character({.body = "limb", .vertices = 400}).mesh);
    const double of_gradient = 2.0 * std::sqrt(3.0) * test_support::motion_error(2, 1.15) * worst.inverse_edges +
                               test_support::rounding_error(12 + 3, worst.condition);
    EXPECT_LT(strain_jump(rest, "rigid", "lbs"), 2.0 * std::sqrt(3.0) * of_gradient);
    ASSERT_NE(measurement(rest, "iterations_over_rigid_weights"), nullptr);
    EXPECT_DOUBLE_EQ(measurement(rest, "iterations_over_rigid_weights")->value, 1.0);
}

}  // namespace

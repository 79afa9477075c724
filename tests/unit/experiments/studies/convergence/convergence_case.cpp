// Reference: the distance of LBS from the reference, measured here, and the list of the meshes that have one.
#include "experiments/studies/convergence/convergence_case.hpp"

#include "experiments/studies/convergence/convergence_records.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace experiments;

constexpr int fewer = 300, more = 700, between = 500;  // vertices

ConvergenceCase two_sizes(bool ladder)
{
    ConvergenceCase of;
    of.scene = read_scene("limb_twist", {"character.vertices=" + std::to_string(fewer)});
    of.frames = {{3, "twist 15", {}, true}};
    of.k_stretch = {0.2};
    of.settings = {{}};
    of.other_vertices = {more};
    of.ladder = ladder;
    of.most_iterations = 30;
    of.truth = "snh_p1";
    return of;
}

TEST(ConvergenceCase, TheDistanceToTheReferenceBeginsWithThatOfLbs)
{
    const ConvergenceResult result = measure_convergence(two_sizes(true));
    EXPECT_EQ(result.breakdown, "");
    ASSERT_EQ(result.all.size(), 2u);
    for (const ConvergencePaths& paths : result.all) {
        const Scene scene = read_scene("limb_twist", {"character.vertices=" + std::to_string(paths.own_mesh ? fewer : more)});
        const PosedCharacter limb(scene, {3});
        ASSERT_EQ(limb.character().mesh.rest.rows(), paths.vertices);
        const double of_lbs =
            limb.distance(limb.shapes(spec_of(scene, "snh_p1")).front(), limb.shapes(spec_of(scene, "lbs")).front()).joint_pct;
        EXPECT_GT(of_lbs, 0.0);
        // The path's positions are relative to an origin: each coordinate goes through two more roundings. They are related to the mean
        // distance of the flesh from the bones, two thirds of the radius of 0.15 m; other sums and quotients have a different order at
        // most.
        const double rounding_pct = 100.0 * std::sqrt(3.0) * test_support::rounding_error(2, 1.15) / 0.1;
        EXPECT_NEAR(paths.paths.front().looks.front().error_joint_pct, of_lbs, rounding_pct + test_support::rounding_error(20, of_lbs));
        EXPECT_EQ(paths.reference, "snh_p1");
    }
}

TEST(ConvergenceCase, AboveTruthToThereIsNoReferenceAndTheRecordSaysSo)
{
    ConvergenceCase of = two_sizes(true);
    of.truth_to = between;
    const ConvergenceResult result = measure_convergence(of);
    ASSERT_EQ(result.all.size(), 2u);
    ASSERT_LE(result.all.front().vertices, between);
    ASSERT_GT(result.all.back().vertices, between);
    EXPECT_TRUE(std::isfinite(result.all.front().paths.front().looks.back().error_joint_pct));
    EXPECT_TRUE(std::isnan(result.all.back().paths.front().looks.back().error_joint_pct));
    EXPECT_EQ(result.all.back().reference, "left_out_above_500_vertices");

    const analysis::CsvTable towards = table_of(experiments::towards_columns, towards_rows(look_rows(result)));
    EXPECT_EQ(rate_rows(result).back().reference, "left_out_above_500_vertices");
    ASSERT_GT(towards.rows(), 0);
    for (int row = 0; row < towards.rows(); ++row) EXPECT_EQ(towards.integer(row, "vertices"), result.all.front().vertices);
}

TEST(ConvergenceCase, OtherTessellationsOfASizeHaveNone)
{
    const ConvergenceResult result = measure_convergence(two_sizes(false));
    EXPECT_EQ(result.all.front().reference, "snh_p1");
    EXPECT_EQ(result.all.back().reference, "own_mesh_alone");
}

}  // namespace

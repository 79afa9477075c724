// Reference: the distance of LBS from the reference, measured here, and the list of the meshes and poses that have one.
#include "experiments/studies/convergence/convergence_case.hpp"

#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "experiments/studies/shared/posed_reference.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace experiments;

constexpr int fewer = 300, more = 500, between = 400;  // vertices

ConvergenceCase two_sizes(bool ladder)
{
    ConvergenceCase of;
    of.scene = read_scene("limb_twist", {"character.vertices=" + std::to_string(fewer)});
    of.frames = {{3, "twist 15", {}, true, true}};
    of.k_stretch = {0.2};
    of.settings = {{}};
    of.other_vertices = {more};
    of.ladder = ladder;
    of.most_iterations = 30;
    of.reference = reference_flesh(of.scene);
    return of;
}

TEST(ConvergenceCase, TheDistanceToTheReferenceBeginsWithThatOfLbs)
{
    const ConvergenceCase of = two_sizes(true);
    const ConvergenceResult result = measure_convergence(of);
    EXPECT_EQ(result.breakdown, "");
    ASSERT_EQ(result.all.size(), 2u);
    for (const ConvergencePaths& paths : result.all) {
        const Scene scene =
            read_scene("limb_twist", {"character.vertices=" + std::to_string(paths.of.own_mesh ? fewer : more)});
        const PosedCharacter limb(scene, {3});
        ASSERT_EQ(limb.character().mesh.rest.rows(), paths.of.vertices);
        const PosedReference reference(limb.character(), of.reference, limb.pose(0), scene.motion.time_step_s,
                                       ReferenceEffort::own_tets);
        const double of_lbs = reference.error_of(limb.shapes(spec_of(scene, "lbs")).front().positions).joint_pct;
        EXPECT_GT(of_lbs, 0.0);
        // The path's positions are relative to an origin: each coordinate goes through two more roundings. They are
        // related to the mean distance of the flesh from the bones, two thirds of the radius of 0.15 m; other sums and
        // quotients have a different order at most.
        const double rounding_pct = 100.0 * std::sqrt(3.0) * test_support::rounding_error(2, 1.15) / 0.1;
        const Look& first = paths.paths.front().looks.front();
        EXPECT_NEAR(first.error_joint_pct, of_lbs, rounding_pct + test_support::rounding_error(20, of_lbs));
        EXPECT_EQ(first.whole_joint_pct, first.error_joint_pct);  // nothing is creased
        EXPECT_EQ(paths.reference, "neo_hookean");
        EXPECT_EQ(paths.quality.masked_share_pct, 0.0);
        EXPECT_FALSE(paths.quality.bound_pct);  // on a ladder: its references have no other tets
    }
}

TEST(ConvergenceCase, AboveReferenceToThereIsNoneAndTheRecordSaysSo)
{
    ConvergenceCase of = two_sizes(true);
    of.reference_to = between;
    const ConvergenceResult result = measure_convergence(of);
    ASSERT_EQ(result.all.size(), 2u);
    ASSERT_LE(result.all.front().of.vertices, between);
    ASSERT_GT(result.all.back().of.vertices, between);
    EXPECT_TRUE(std::isfinite(result.all.front().paths.front().looks.back().error_joint_pct));
    EXPECT_TRUE(std::isnan(result.all.back().paths.front().looks.back().error_joint_pct));
    EXPECT_EQ(result.all.back().reference, "left_out_above_400_vertices");

    const analysis::CsvTable towards = table_of(experiments::towards_columns, towards_rows(look_rows(result)));
    EXPECT_EQ(rate_rows(result).back().reference, "left_out_above_400_vertices");
    ASSERT_GT(towards.rows(), 0);
    for (int row = 0; row < towards.rows(); ++row)
        EXPECT_EQ(towards.integer(row, "vertices"), result.all.front().of.vertices);
}

// A reference that is not reached, or a pose that is not compared.
void expect_no_errors(ConvergenceCase of, const std::string& reason)
{
    of.other_vertices.clear();
    const ConvergenceResult result = measure_convergence(of);
    ASSERT_EQ(result.all.size(), 1u);
    EXPECT_EQ(result.all.front().reference, reason);
    EXPECT_FALSE(result.all.front().quality.masked_share_pct);
    EXPECT_FALSE(result.all.front().quality.bound_pct);
    EXPECT_TRUE(towards_rows(look_rows(result)).empty());
    for (const RateRow& row : rate_rows(result)) EXPECT_TRUE(std::isnan(row.paper.error_joint_pct));
}

TEST(ConvergenceCase, WithoutAReferenceThereAreNoErrors)
{
    const ConvergenceResult tessellations = measure_convergence(two_sizes(false));
    EXPECT_EQ(tessellations.all.front().reference, "neo_hookean");
    EXPECT_EQ(tessellations.all.back().reference, "own_mesh_alone");
    ConvergenceCase not_reached = two_sizes(false), not_compared = not_reached;
    not_reached.frames.front().frame = 18;
    options_of<FemOptions>(not_reached.reference).most_newton_steps = 1;
    expect_no_errors(not_reached, "neo_hookean_was_not_reached");
    not_compared.frames.front().compared = false;
    expect_no_errors(not_compared, "none");
}

// The second path from LBS is another run of the same iterations.
TEST(ConvergenceCase, TheControlsOfThePapersOrderAreLbsOnceMoreAndRandomPositions)
{
    ConvergenceCase of = two_sizes(false);
    of.scene = read_scene("limb_bend", {"character.vertices=" + std::to_string(fewer)});
    of.frames = {{3, "bend 15"}};
    of.settings = {{pbs::Order::plain, pbs::Precision::f64}, {}};
    of.other_vertices.clear();
    const ConvergenceResult result = measure_convergence(of);
    ASSERT_EQ(result.all.size(), 2u);
    const ConvergencePaths& papers = result.all.front();
    ASSERT_EQ(papers.controls.size(), 2u);
    EXPECT_EQ(papers.controls[0].last, papers.paths[0].last);
    EXPECT_GT(papers.controls[1].looks.front().combined, 10.0 * papers.paths[0].looks.front().combined);
    EXPECT_GT(papers.controls[1].looks.back().combined, papers.paths[0].looks.back().combined);
    EXPECT_FALSE(papers.author) << "the limb is no character";
    EXPECT_TRUE(result.all.back().controls.empty()) << "another order";
    of.frames.front().twist = true;
    EXPECT_TRUE(measure_convergence(of).all.front().controls.empty());
}

TEST(ConvergenceCase, FromLbsAloneThereIsOnePath)
{
    ConvergenceCase of = two_sizes(true);
    of.frames.front().compared = false;
    of.from_lbs_alone = true;
    for (const ConvergencePaths& paths : measure_convergence(of).all) {
        EXPECT_EQ(paths.paths.size(), 1u);
        EXPECT_TRUE(paths.controls.empty());
    }
}

}  // namespace

// Reference: theory, and the equilibrium that the same body reaches from its rest pose. Newton's method for finite
// elements begins at distorted shapes.
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/studies/stability/stability_cells.hpp"
#include "tests/support/newton_rounding.hpp"

#include <gtest/gtest.h>

namespace {

using namespace experiments;
using analysis::StabilityOutcome;

// From the study: a limb of 400 vertices bent by 90 degrees. Here the bones are rigid, since the study's weaker springs
// leave flesh more equilibria.
StabilityCell cell_of(const std::string& model, Start start)
{
    for (StabilityCell cell : stability_cells("fem_static")) {
        options_of<FemOptions>(cell.spec).attachment = FemAttachment::embedded;
        if (cell.model == model && cell.disturbance.start == start) return cell;
    }
    ADD_FAILURE() << "no such cell of " << model;
    return {};
}

pbs::Positions after_a_step(const StabilityCell& cell)
{
    StabilityBody body(cell);
    const auto driven = make_driven_body(cell, body.character());
    driven->advance(body.drive(0), cell.time_step_s);
    return driven->positions();
}

TEST(BrokenFemStarts, EveryModelInEquilibriumIsGivenThem)
{
    for (const char* model : {"fem_linear", "fem_corotational", "fem_stable_neo_hookean"})
        for (const Start start : {Start::flattened, Start::mirrored, Start::random, Start::point})
            EXPECT_EQ(options_of<FemOptions>(cell_of(model, start).spec).element_order, 1);
}

// Theory: the problem is one linear system, whatever the initial state.
TEST(BrokenFemStarts, ALinearBodyHasNoStart)
{
    StabilityCell cell = cell_of("fem_linear", Start::flattened);
    const pbs::Positions flattened = after_a_step(cell);
    for (const Start start : {Start::mirrored, Start::random, Start::point, Start::none}) {
        cell.disturbance.start = start;
        cell.disturbance.stays = start == Start::none;
        EXPECT_EQ((after_a_step(cell) - flattened).cwiseAbs().maxCoeff(), 0.0);
    }
}

// How far two states may lie apart that Newton's method takes for the equilibrium in the last pose [diagonals].
double newton_error(StabilityCell cell)
{
    cell.disturbance.start = Start::none;
    cell.disturbance.stays = true;
    StabilityBody body(cell);
    return 2.0 *
           test_support::newton_error_m(body.character(), options_of<FemOptions>(cell.spec), body.drive(0).pose,
                                        after_a_step(cell)) /
           body.diagonal_m();
}

// The energy is defined for inverted tets and for those without a volume.
TEST(BrokenFemStarts, StableNeoHookeanFleshFindsBackFromBeingMirroredAndFromAPoint)
{
    for (const Start start : {Start::mirrored, Start::point}) {
        const StabilityCell cell = cell_of("fem_stable_neo_hookean", start);
        const CellResult result = run_cell(cell);
        EXPECT_EQ(result.stability.outcome, StabilityOutcome::converged);
        EXPECT_EQ(result.steps_not_reached, 0);
        ASSERT_TRUE(result.iterations_until_reached);
        EXPECT_GT(*result.iterations_until_reached, 1);
        EXPECT_LT(result.steps.back().from_undisturbed, newton_error(cell));
    }
}

// The corotational energy does not penalise the inversion of a tet: mirrored flesh ends with inverted tets, far from
// the undisturbed shape. Flattened flesh comes to rest in another equilibrium, without an inverted tet: bounded does
// not mean correct.
TEST(BrokenFemStarts, CorotationalFleshStaysMirroredAndFlattenedFleshRestsElsewhere)
{
    const CellResult mirrored = run_cell(cell_of("fem_corotational", Start::mirrored));
    EXPECT_EQ(mirrored.stability.outcome, StabilityOutcome::inverted);
    EXPECT_GT(mirrored.steps.back().inverted_tets, 0);
    const CellResult flattened = run_cell(cell_of("fem_stable_neo_hookean", Start::flattened));
    EXPECT_EQ(flattened.stability.outcome, StabilityOutcome::bounded);
    EXPECT_TRUE(flattened.steps.back().solved);
    EXPECT_EQ(flattened.steps.back().inverted_tets, 0);
    EXPECT_LT(flattened.steps.back().motion, analysis::StabilityBounds{}.rest_motion);
    for (const CellResult* result : {&mirrored, &flattened})
        EXPECT_GT(result->steps.back().from_undisturbed, analysis::StabilityBounds{}.near_undisturbed);
}

}  // namespace

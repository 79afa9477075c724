// Reference: the correct solver compared with a deliberately broken one, which the outcome must distinguish.

#include "experiments/deformers/registry.hpp"
#include "experiments/studies/stability/stability_cells.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/solver/options.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/two_bone_limb.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace experiments;
using analysis::StabilityOutcome;

StabilityCell pbs_cell()
{
    StabilityCell cell;
    cell.spec = default_spec("pbs");
    cell.disturbance.turning_steps = 3;
    cell.still_steps = 12;
    return cell;
}

pbs::PbsOptions& pbs_of(StabilityCell& cell)
{
    return options_of<pbs::PbsOptions>(cell.spec);
}

StabilityOutcome outcome(const StabilityCell& cell)
{
    return run_cell(cell).stability.outcome;
}

TEST(CellRun, SoundSolverConvergesAndABrokenStartTellsTheIterationsUntilItWasReached)
{
    const CellResult result = run_cell(pbs_cell());
    EXPECT_EQ(result.stability.outcome, StabilityOutcome::converged);
    EXPECT_TRUE(result.has_undisturbed);
    EXPECT_EQ(result.steps_not_reached, 0);
    EXPECT_FALSE(result.iterations_until_reached);
    StabilityCell mirrored = pbs_cell();
    mirrored.disturbance.start = Start::mirrored;
    EXPECT_EQ(run_cell(mirrored).iterations_until_reached, pbs_of(mirrored).iterations);
}

TEST(CellRun, SignOfTheVolumeGradientAsPrintedDivergesAndWithoutVolumeConstraintsTetsStayInverted)
{
    StabilityCell cell = pbs_cell(), without_volume = pbs_cell();
    pbs_of(cell).order = pbs::Order::plain;
    EXPECT_EQ(outcome(cell), StabilityOutcome::converged);
    pbs_of(cell).volume_form = pbs::VolumeForm::sign;
    EXPECT_EQ(outcome(cell), StabilityOutcome::diverged);
    pbs_of(without_volume).k_volume = 0.0;
    EXPECT_EQ(outcome(without_volume), StabilityOutcome::inverted);
}

// The controls of C08: in the rest pose and without gravity every constraint is satisfied; a projection with the
// printed sign doubles the error that it should remove.
TEST(CellRun, WhatNothingDisturbsStaysAtRestAndThePrintedSignDiverges)
{
    const auto outcome_of = [](const std::vector<StabilityCell>& cells, const std::string& model, double time_step_s) {
        for (const StabilityCell& cell : cells)
            if (cell.model == model && cell.factor == "time_step" && cell.time_step_s == time_step_s)
                return outcome(cell);
        ADD_FAILURE() << "no cell of " << model;
        return StabilityOutcome::bounded;
    };
    EXPECT_EQ(outcome_of(stability_cells("controls"), "pbs_undisturbed", 1.0), StabilityOutcome::converged);
    EXPECT_EQ(outcome_of(stability_cells("pbs_character", "human"), "pbs_undisturbed", 0.1),
              StabilityOutcome::converged);
    EXPECT_EQ(outcome_of(stability_cells("controls"), "pbs_printed_sign", 0.01), StabilityOutcome::diverged);
}

// The square of 1e25 m is not representable in f32, but it is in f64.
TEST(CellRun, ATeleportBeyondTheNumbersIsNotFinite)
{
    StabilityCell cell = pbs_cell();
    pbs_of(cell).jiggle = pbs::Jiggle{0.2};
    cell.disturbance.teleport_m = 1e25;
    EXPECT_EQ(outcome(cell), StabilityOutcome::not_finite);
    pbs_of(cell).precision = pbs::Precision::f64;
    EXPECT_NE(outcome(cell), StabilityOutcome::not_finite);
}

// Without constraints, no jiggling vertex knows its place: the fall has no end.
TEST(CellRun, WithoutAnyConstraintWhatJigglesFallsAway)
{
    StabilityCell cell = pbs_cell();
    cell.still_steps = 120;
    pbs_of(cell).gravity_m_s2 = pbs::Vec3(0.0, -9.81, 0.0);
    pbs_of(cell).jiggle = pbs::Jiggle{0.2};
    const StabilityOutcome sound = outcome(cell);
    EXPECT_TRUE(sound == StabilityOutcome::bounded || sound == StabilityOutcome::converged);
    pbs_of(cell).k_volume = pbs_of(cell).k_bind = pbs_of(cell).k_stretch = pbs_of(cell).jiggle->k_stretch = 0.0;
    EXPECT_EQ(outcome(cell), StabilityOutcome::diverged);
}

TEST(CellRun, WithoutJiggleTheTimeStepDoesNotEnterAndATeleportIsForgotten)
{
    StabilityCell cell = pbs_cell(), teleported = pbs_cell();
    const CellResult hundredth = run_cell(cell);
    cell.time_step_s = 1.0;
    const CellResult second = run_cell(cell);
    ASSERT_EQ(hundredth.steps.size(), second.steps.size());
    for (std::size_t i = 0; i < second.steps.size(); ++i) EXPECT_EQ(hundredth.steps[i].reach, second.steps[i].reach);
    teleported.disturbance.teleport_m = 1000.0;
    const CellResult result = run_cell(teleported);
    EXPECT_EQ(result.stability.outcome, StabilityOutcome::converged);
    EXPECT_EQ(result.stability.recovery_steps, 0);
}

// With forgotten multipliers, a soft body comes to rest in another state than the correct one, since its iterations
// have stiffened it.
TEST(CellRun, ForgottenMultipliersEndElsewhere)
{
    StabilityCell cell = pbs_cell();
    cell.spec = default_spec("xpbd");
    options_of<pbs::XpbdOptions>(cell.spec).young_pa = 1e4;
    cell.disturbance.angle_deg = 45.0;
    const auto last_positions = [&] {
        StabilityBody body(cell);
        const auto driven = make_driven_body(cell, body.character());
        for (int step = 0; step < body.steps(); ++step) driven->advance(body.drive(step), cell.time_step_s);
        return driven->positions();
    };
    const pbs::Positions sound = last_positions();
    options_of<pbs::XpbdOptions>(cell.spec).keep_multipliers = false;
    StabilityBody body(cell);
    const pbs::Positions broken = last_positions();
    const Drive last = body.drive(body.steps() - 1);
    const auto outcome_against = [&](const pbs::Positions& positions) {
        const analysis::StabilityStep step =
            analysis::stability_step(positions, positions, {last.bind_points, body.character().binding.distance},
                                     body.character().mesh.tets, body.diagonal_m(), &sound);
        return analysis::outcome_of(std::vector<analysis::StabilityStep>(20, step), 0).outcome;
    };
    EXPECT_EQ(outcome_against(sound), StabilityOutcome::converged);
    EXPECT_EQ(outcome_against(broken), StabilityOutcome::bounded);
}

// Theory: predicted positions are x + (x - x_before) + g dt^2, so 64 times the step equals 64^2 times the gravity, and
// powers of two are exact. The test uses a smooth initial state in double, since roundings grow to centimetres within a
// few steps where tets are inverted.
TEST(CellRun, WithJiggleTheTimeStepEntersBesideGravityAlone)
{
    StabilityCell cell = pbs_cell();
    cell.still_steps = 5;
    cell.disturbance.stays = true;
    pbs_of(cell).precision = pbs::Precision::f64;
    pbs_of(cell).jiggle = pbs::Jiggle{0.2};
    const auto steps_under = [&](double gravity_m_s2, double time_step_s) {
        pbs_of(cell).gravity_m_s2 = pbs::Vec3(0.0, -gravity_m_s2, 0.0);
        cell.time_step_s = time_step_s;
        return run_cell(cell).steps;
    };
    const double little = 1.0 / 1024.0, much = 64.0 * 64.0 * little, short_s = 1.0 / 64.0;
    const auto slow = steps_under(little, 1.0), heavy = steps_under(much, short_s),
               light = steps_under(little, short_s);
    ASSERT_EQ(slow.size(), heavy.size());
    for (std::size_t i = 0; i < slow.size(); ++i) EXPECT_EQ(slow[i].motion, heavy[i].motion) << i;
    EXPECT_NE(slow.back().motion, light.back().motion);
}

// Reference: the heights and lengths of the tets themselves.

const pbs::TetMesh mesh = test_support::two_bone_limb({16, 4, 4}, pbs::Vec3::UnitZ(), 0.0).mesh;

// A tet with a vertex at the share s of its height has s of its volume; so does one whose edge is shortened to s of its
// length towards one corner. The corners of a thin tet stay in place, and no other tet is as thin or inverted. Kuhn
// tets of cells of width b = 0.075 m across have heights of at least b / sqrt 2, and the place of a vertex goes through
// six roundings of each coordinate of a metre at most. A volume goes through ten roundings of products of three edges,
// of at most five times its size. A twentieth of the vertices is moved at most.
TEST(DistortedMesh, TheThinnestTetKeepsTheWantedShareOfItsVolume)
{
    for (const Defect defect : {Defect::slivers, Defect::needles})
        for (const double thinness : {1e-1, 1e-3, 1e-6}) {
            const pbs::TetMesh spoilt = distorted(mesh, defect, thinness);
            const Eigen::ArrayXd volumes = pbs::tet_volumes(spoilt.rest, spoilt.tets),
                                 at_rest = pbs::tet_volumes(mesh.rest, mesh.tets);
            EXPECT_NEAR((volumes / at_rest).minCoeff(), thinness,
                        test_support::rounding_error(6 * std::sqrt(3.0), 1.0) * std::sqrt(2.0) / 0.075 +
                            test_support::rounding_error(2 * 10 * 5, 1.0));
            EXPECT_GT(volumes.minCoeff(), 0.0);
            const auto moved = ((spoilt.rest - mesh.rest).rowwise().norm().array() > 0.0).count();
            EXPECT_GT(moved, 0);
            EXPECT_LE(moved, static_cast<Eigen::Index>(0.05 * static_cast<double>(mesh.rest.rows())));
            EXPECT_EQ(distorted(mesh, defect, thinness).rest, spoilt.rest) << "it is the same every time";
        }
    EXPECT_EQ(distorted(mesh, Defect::none, 1e-3).rest, mesh.rest);
}

}  // namespace

// Reference: the definition of each initial guess.
#include "experiments/studies/convergence/convergence_case.hpp"

#include "pbs/solver/pbs_solver.hpp"
#include "tests/support/bar_character.hpp"

#include <gtest/gtest.h>

namespace {

using experiments::FrameStarts;
using experiments::SolverStart;

const test_support::TwoBoneLimb limb = test_support::two_bone_limb({16, 4, 4}, pbs::Vec3::UnitZ(), 0.0);
const pbs::Character character = test_support::character_of(limb);
const pbs::Motion bending = pbs::joint_sweep(limb.skeleton, 1, pbs::Vec3::UnitZ(), 60.0, 4, 0.01);

const pbs::Positions& shape(const FrameStarts& frame, SolverStart start)
{
    return frame.shapes[static_cast<int>(start)];
}

pbs::Positions blended(const pbs::Weights& weights, const pbs::Pose& pose)
{
    pbs::Positions positions;
    pbs::linear_blend_skinning(limb.mesh.rest, weights, pose, positions);
    return positions;
}

TEST(Starts, AreWhatTheyAreCalled)
{
    const FrameStarts frame = experiments::starts_of(character, bending, {3}, {}).front();
    EXPECT_EQ(shape(frame, SolverStart::lbs), blended(limb.weights, bending.steps[3]));
    EXPECT_EQ(shape(frame, SolverStart::rigid_bind), blended(pbs::rigid_weights(limb.binding), bending.steps[3]));
    EXPECT_EQ(shape(frame, SolverStart::rest_pose), limb.mesh.rest);
    EXPECT_EQ(frame.bind_points, pbs::posed_bind_points(limb.binding, bending.steps[3]));
    EXPECT_NE(shape(frame, SolverStart::lbs), shape(frame, SolverStart::rigid_bind));
}

TEST(Starts, ThePreviousFrameIsWhatTheSolverMadeOfTheOneBefore)
{
    pbs::PbsSolver solver(limb.mesh, limb.binding.distance, {}, {});
    pbs::Positions positions = limb.mesh.rest;
    for (int step = 0; step < 3; ++step) {
        solver.advance(positions, pbs::posed_bind_points(limb.binding, bending.steps[step]), 0.01);
        positions = solver.positions();
    }
    EXPECT_EQ(shape(experiments::starts_of(character, bending, {3}, {}).front(), SolverStart::previous_frame), positions);
    EXPECT_EQ(shape(experiments::starts_of(character, bending, {1, 3}, {}).back(), SolverStart::previous_frame), positions);
}

TEST(Starts, OfTheFirstFrameThereIsNoneBefore)
{
    const FrameStarts frame = experiments::starts_of(character, bending, {0}, {}).front();
    EXPECT_EQ(shape(frame, SolverStart::previous_frame), shape(frame, SolverStart::lbs));
}

TEST(Starts, FollowTheStepsOfAMotionWithSeveralAFrame)
{
    pbs::Motion slower = bending;
    slower.steps_per_frame = 3;
    EXPECT_EQ(shape(experiments::starts_of(character, slower, {1}, {}).front(), SolverStart::previous_frame),
              shape(experiments::starts_of(character, bending, {3}, {}).front(), SolverStart::previous_frame));
}

}  // namespace

// Reference: the solver, LBS and the metrics, called directly.
#include "experiments/studies/ambiguity/read_motion.hpp"

#include "analysis/metrics/frame_metrics.hpp"
#include "pbs/skinning/blend.hpp"
#include "pbs/solver/pbs_solver.hpp"
#include "tests/support/limb_character.hpp"

#include <gtest/gtest.h>

namespace {

using experiments::Reading;
using experiments::ReadMotion;

const test_support::TwoBoneLimb limb = test_support::two_bone_limb({16, 4, 4}, pbs::Vec3::UnitZ(), 0.0);
const pbs::Character character = test_support::character_of(limb);

experiments::Scene bending()
{
    experiments::Scene scene;
    scene.name = "bending";
    scene.motion.joint = "forearm";
    scene.motion.axis = pbs::Vec3::UnitZ();
    scene.motion.angle_deg = 60.0;
    scene.motion.frames = 4;
    return scene;
}

Reading plainly()
{
    return {.place = "", .name = "own", .baseline = "own", .options = {}};
}

TEST(ReadMotion, OfTheScenesOwnReadingIsTheSolvers)
{
    const ReadMotion moved = experiments::move(character, bending(), plainly());
    ASSERT_EQ(moved.shapes.size(), 4u);
    const pbs::Pose pose = pbs::joint_sweep(limb.skeleton, 1, pbs::Vec3::UnitZ(), 60.0, 4, 0.01).steps[2];
    pbs::Positions lbs;
    pbs::BlendSkinning<double>(limb.mesh.rest, limb.weights).linear(pose, lbs);
    pbs::PbsSolver solver(limb.mesh, limb.binding.distance, {}, {});
    solver.advance(lbs, pbs::posed_bind_points(limb.binding, pose), 0.01);
    EXPECT_EQ(moved.shapes[2], solver.positions());
    const analysis::MeshMetrics mesh_metrics(limb.mesh.rest, limb.mesh.tets);
    EXPECT_EQ(moved.pbs.volume_change_pct[2], mesh_metrics.measure(solver.positions()).volume_change_pct);
    EXPECT_EQ(moved.lbs.volume_change_pct[2], mesh_metrics.measure(lbs).volume_change_pct);
    EXPECT_EQ(moved.pbs.angle_deg, (std::vector<double>{0.0, 20.0, 40.0, 60.0}));
    EXPECT_TRUE(moved.finite);
}

TEST(ReadMotion, ByIncrementDependsOnThePathAndByStartDoesNot)
{
    experiments::Scene coarse = bending();
    coarse.motion.frames = 2;
    Reading increment = plainly();
    EXPECT_EQ(experiments::move(character, bending(), increment).shapes.back(),
              experiments::move(character, coarse, increment).shapes.back());
    increment.options.lbs_entry = pbs::LbsEntry::increment;
    EXPECT_NE(experiments::move(character, bending(), increment).shapes.back(),
              experiments::move(character, coarse, increment).shapes.back());
}

// The bones touch only in the middle, so near the outer ends either_end blends where nearest_end does not.
TEST(ReadMotion, EitherEndMovesWhatEqTwoLeavesToOneBone)
{
    Reading either = plainly();
    either.blended_bones = experiments::BlendedBones::either_end;
    const ReadMotion own = experiments::move(character, bending(), plainly()), other = experiments::move(character, bending(), either);
    EXPECT_EQ(own.lbs.volume_change_pct[0], other.lbs.volume_change_pct[0]);  // at rest
    EXPECT_NE(own.lbs.volume_change_pct[3], other.lbs.volume_change_pct[3]);
}

TEST(ReadMotion, BindPointsProjectedAnewChangeTheShape)
{
    Reading anew = plainly();
    anew.bind_point = experiments::BindPoint::reprojected;
    EXPECT_NE(experiments::move(character, bending(), anew).shapes[3], experiments::move(character, bending(), plainly()).shapes[3]);
}

}  // namespace

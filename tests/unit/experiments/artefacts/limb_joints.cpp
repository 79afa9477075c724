// Truth: the built-in limb's skeleton, (-1,0,0) -> 0 -> (1,0,0), and a bent one drawn by hand.
#include "experiments/artefacts/limb_joints.hpp"

#include "pbs/character/bodies.hpp"

#include <gtest/gtest.h>

namespace {

using pbs::Vec3;

TEST(LimbJoints, LimbHasOneInItsMiddle)
{
    const pbs::Character limb = pbs::make_character({.body = "limb", .vertices = 600});
    const auto joints = experiments::limb_joints(limb);
    ASSERT_EQ(joints.size(), 1u);
    EXPECT_EQ(joints[0].name, "upper|forearm");
    EXPECT_NEAR(joints[0].point.norm(), 0.0, 1e-12);
    EXPECT_NEAR(joints[0].half_parent_m, 0.5, 1e-12);
    EXPECT_NEAR(joints[0].radius_m, 0.15, 1e-3);  // the caps' vertices lie as far from the bones' ends
    EXPECT_NEAR((experiments::twist_axis(limb.skeleton, joints[0]) - Vec3::UnitX()).norm(), 0.0, 1e-12);
    EXPECT_NEAR((experiments::hinge_axis(limb.skeleton, joints[0]) - Vec3::UnitZ()).norm(), 0.0, 1e-12);
}

TEST(LimbJoints, HingeBendsOnTheWayThatTheJointIsBent)
{
    pbs::Skeleton skeleton;
    skeleton.bones = {{"upper", -1, {-1, 0, 0}, {0, 0, 0}}, {"forearm", 0, {0, 0, 0}, {1, 0.2, 0}}};
    const experiments::LimbJoint joint{"upper|forearm", 0, 1, Vec3::Zero(), 0.1, 0.5, 0.5};
    EXPECT_NEAR((experiments::hinge_axis(skeleton, joint) - Vec3::UnitZ()).norm(), 0.0, 1e-12);
    skeleton.bones[1].tail.y() = -0.2;
    EXPECT_NEAR((experiments::hinge_axis(skeleton, joint) + Vec3::UnitZ()).norm(), 0.0, 1e-12);
}

TEST(LimbJoints, HingeOfAStraightLimbAlongZIsStillAcrossIt)
{
    pbs::Skeleton skeleton;
    skeleton.bones = {{"upper", -1, {0, 0, -1}, {0, 0, 0}}, {"forearm", 0, {0, 0, 0}, {0, 0, 1}}};
    const Vec3 axis = experiments::hinge_axis(skeleton, {"upper|forearm", 0, 1, Vec3::Zero(), 0.1, 0.5, 0.5});
    EXPECT_NEAR(axis.norm(), 1.0, 1e-12);
    EXPECT_NEAR(axis.z(), 0.0, 1e-12);
}

TEST(LimbJoints, NearIsWithinAThirdOfEachBone)
{
    const pbs::Character limb = pbs::make_character({.body = "limb", .vertices = 600});
    const auto near = experiments::near_joint(limb, experiments::limb_joints(limb)[0]);
    for (Eigen::Index v = 0; v < limb.mesh.rest.rows(); ++v)
        EXPECT_EQ(near[v], std::abs(limb.mesh.rest(v, 0)) <= 1.0 / 3.0) << limb.mesh.rest.row(v);
}

}  // namespace

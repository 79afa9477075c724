// Reference: poses of nodes and skinned points, computed by hand. Tolerances: at most 64 roundings of numbers of at most 8.
#include "pbs/rig/rig_pose.hpp"

#include "tests/support/rounding_error.hpp"
#include "tests/support/two_joint_rig.hpp"

#include <gtest/gtest.h>

namespace {

using namespace pbs;
using test_support::two_joint_rig;

const double skin_rounding = test_support::rounding_error(64, 8.0);

void expect_points(const Positions& points, const Positions& expected)
{
    ASSERT_EQ(points.rows(), expected.rows());
    EXPECT_LE((points - expected).cwiseAbs().maxCoeff(), skin_rounding) << points << "\nexpected\n" << expected;
}

Positions posed(const Rig& rig, double time_s)
{
    return skinned_points(rig.meshes[0], node_transforms(rig, &rig.animations[0], time_s));
}

TEST(NodeTransforms, ArePutTogetherFromTranslationRotationAndScale)
{
    NodeTransform transform;
    transform.translation = Vec3(1, 2, 3);
    transform.rotation = Eigen::Quaterniond(0, 0, 0, 1);  // half round about z
    transform.scale = Vec3(2, 3, -4);
    EXPECT_EQ(transform.affine() * Vec3(1, 1, 1), Vec3(-1, -1, -1));
    transform.matrix = Eigen::Affine3d(Eigen::Scaling(2.0));
    EXPECT_EQ(transform.affine() * Vec3(1, 1, 1), Vec3(2, 2, 2));
}

TEST(NodeTransforms, AreThoseOfTheNodesAboveToo)
{
    Rig rig = two_joint_rig();
    rig.nodes[0].rest.scale = Vec3(2, 2, 2);
    const auto nodes = node_transforms(rig, nullptr, 0.0);
    EXPECT_EQ(nodes[0] * Vec3(0, 0, 0), Vec3(1, 0, 0));
    EXPECT_EQ(nodes[1] * Vec3(1, 0, 0), Vec3(3, 4, 0));
}

TEST(NodeTransforms, WhatHasNoKeysStaysAsItIsAtRest)
{
    Rig rig = two_joint_rig();
    rig.nodes[1].rest.scale = Vec3(1, 3, 1);
    const auto nodes = node_transforms(rig, &rig.animations[0], 1.0);
    EXPECT_LE((nodes[1] * Vec3(0, 1, 0) - Vec3(1, -1, 0)).norm(), skin_rounding);
}

TEST(SkinnedPoints, AtRestAreThoseOfTheMeshWhereTheBindPoseIsTheRestPose)
{
    const Rig rig = two_joint_rig();
    expect_points(skinned_points(rig.meshes[0], node_transforms(rig, nullptr, 0.0)), rig.meshes[0].points);
}

TEST(SkinnedPoints, OfTwoJointsByHand)
{
    Positions quarter(4, 3), half(4, 3);
    quarter << 1, 0, 0, 1, 2, 0, -1, 2, 0, 0.25 * 2 + 0.75 * 1, 0.25 * 2 + 0.75 * 3, 0;
    half << 1, 0, 0, 1, 2, 0, 1, 0, 0, 0.25 * 2 + 0.75 * 0, 2, 0;
    expect_points(posed(two_joint_rig(), 0.5), quarter);
    expect_points(posed(two_joint_rig(), 1.0), half);
}

TEST(SkinnedPoints, IgnoreWhereTheNodeOfASkinnedMeshIs)  // glTF 2.0, Sec. 3.7.3.3
{
    Rig rig = two_joint_rig();
    rig.nodes[2].rest.translation = Vec3(5, 5, 5);
    expect_points(posed(rig, 0.5), posed(two_joint_rig(), 0.5));
}

TEST(SkinnedPoints, OfANegativeScaleAreMirrored)
{
    Rig rig = two_joint_rig();
    rig.nodes[0].rest.scale = Vec3(-1, 1, 1);  // about the root joint at x = 1
    Positions mirrored = rig.meshes[0].points;
    mirrored.col(0) = 2.0 - mirrored.col(0).array();
    expect_points(skinned_points(rig.meshes[0], node_transforms(rig, nullptr, 0.0)), mirrored);
}

TEST(SkinnedPoints, WithoutASkinFollowTheirNode)
{
    Rig rig = two_joint_rig();
    rig.meshes[0].joints.clear();
    rig.meshes[0].node = 1;
    Positions expected = rig.meshes[0].points;
    expected.rowwise() += Eigen::RowVector3d(1, 2, 0);
    expect_points(skinned_points(rig.meshes[0], node_transforms(rig, nullptr, 0.0)), expected);
}

// A rigid motion of the root moves all points in the same way, whatever their weights.
TEST(SkinnedPoints, MoveRigidlyWithTheRoot)
{
    Rig rig = two_joint_rig();
    const Positions before = posed(rig, 0.25);
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()));
    const Vec3 shift(0.5, -1, 2);
    rig.nodes[0].rest.rotation = turn;
    rig.nodes[0].rest.translation = turn * Vec3(1, 0, 0) + shift;
    const Positions expected = ((before * turn.toRotationMatrix().transpose()).rowwise() + shift.transpose()).eval();
    expect_points(posed(rig, 0.25), expected);
}

}  // namespace

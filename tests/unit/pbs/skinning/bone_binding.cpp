// Reference: projections on segments along the axes, by hand. Tolerances: the rounding of motions.
#include "pbs/skinning/weights.hpp"

#include "pbs/geometry/input_error.hpp"
#include "tests/support/motion_rounding.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using pbs::Vec3;
using test_support::motion_error;

const pbs::Skeleton limb = {{{"upper", -1, {-1, 0, 0}, {0, 0, 0}}, {"forearm", 0, {0, 0, 0}, {1, 0, 0}}}};

pbs::BoneBinding bind_one(const Vec3& vertex, const pbs::Skeleton& skeleton)
{
    return pbs::bind_to_nearest_bone(pbs::Positions(vertex.transpose()), skeleton);
}

TEST(BoneBinding, BesideABoneIsItsFoot)
{
    const pbs::BoneBinding binding = bind_one({0.25, 0.3, 0.4}, limb);
    EXPECT_EQ(binding.bone[0], 1);
    EXPECT_DOUBLE_EQ(binding.parameter(0), 0.25);
    EXPECT_EQ(Vec3(binding.rest_point.row(0)), Vec3(0.25, 0, 0));
    EXPECT_DOUBLE_EQ(binding.distance(0), 0.5);
}

TEST(BoneBinding, BeyondAnEndIsTheEndWithAnUnclampedParameter)
{
    const pbs::BoneBinding binding = bind_one({1.5, 0, 0}, limb);
    EXPECT_DOUBLE_EQ(binding.parameter(0), 1.5);
    EXPECT_EQ(Vec3(binding.rest_point.row(0)), Vec3(1, 0, 0));
    EXPECT_DOUBLE_EQ(binding.distance(0), 0.5);
    const pbs::BoneBinding before_head = bind_one({-3, 0, 0}, limb);
    EXPECT_DOUBLE_EQ(before_head.parameter(0), -2.0);
    EXPECT_EQ(Vec3(before_head.rest_point.row(0)), Vec3(-1, 0, 0));
    EXPECT_DOUBLE_EQ(before_head.distance(0), 2.0);
}

TEST(BoneBinding, FirstOfEquals)
{
    EXPECT_EQ(bind_one({0, 0.2, 0}, limb).bone[0], 0);
}

TEST(BoneBinding, VertexOnTheBoneHasDistanceZero)
{
    EXPECT_EQ(bind_one({0.5, 0, 0}, limb).distance(0), 0.0);
}

TEST(BoneBinding, ZeroLengthBoneIsAPoint)
{
    const pbs::Skeleton point = {{{"point", -1, {1, 1, 1}, {1, 1, 1}}}};
    const pbs::BoneBinding binding = bind_one({1, 1, 3}, point);
    EXPECT_EQ(binding.bone[0], 0);
    EXPECT_EQ(binding.parameter(0), 0.0);
    EXPECT_EQ(Vec3(binding.rest_point.row(0)), Vec3(1, 1, 1));
    EXPECT_DOUBLE_EQ(binding.distance(0), 2.0);
}

TEST(BoneBinding, WithoutBonesIsRefused)
{
    EXPECT_THROW(bind_one({0, 0, 0}, {}), pbs::InputError);
}

TEST(PosedBindPoints, AreCarriedByTheirBones)
{
    pbs::Positions rest(2, 3);
    rest << -0.5, 0.1, 0, 0.5, 0.1, 0;
    const pbs::BoneBinding binding = pbs::bind_to_nearest_bone(rest, limb);
    const pbs::Pose pose = pbs::joint_sweep(limb, 1, Vec3::UnitZ(), 90.0, 2, 0.01).steps[1];
    const pbs::Positions points = pbs::posed_bind_points(binding, pose);
    EXPECT_LT((Vec3(points.row(0)) - Vec3(-0.5, 0, 0)).norm(), motion_error(1, 0.5));
    EXPECT_LT((Vec3(points.row(1)) - Vec3(0, 0.5, 0)).norm(), motion_error(2, 0.5));
}

// The forearm turned by 90 degrees about z lies along y; (0.1, 0.4, 0) is 0.4 along it, and (0.3, 2, 0) beyond its tail.
TEST(ReprojectedBindPoints, AreOnThePosedSegment)
{
    pbs::Positions rest(2, 3);
    rest << 0.5, 0.1, 0, 0.9, 0.1, 0;
    const pbs::BoneBinding binding = pbs::bind_to_nearest_bone(rest, limb);
    const pbs::Pose bent = pbs::joint_sweep(limb, 1, Vec3::UnitZ(), 90.0, 2, 0.01).steps.back();
    pbs::Positions moved(2, 3);
    moved << 0.1, 0.4, 0, 0.3, 2.0, 0;
    const pbs::Positions points = pbs::reprojected_bind_points(binding, limb, bent, moved);
    EXPECT_LT((Vec3(points.row(0)) - Vec3(0, 0.4, 0)).norm(), motion_error(3, 1.0));  // two of the bone, one for the projection
    EXPECT_LT((Vec3(points.row(1)) - Vec3(0, 1, 0)).norm(), motion_error(3, 1.0));
}

TEST(ReprojectedBindPoints, OfARigidlyMovedBodyAreTheCarriedOnes)
{
    pbs::Positions rest(2, 3);
    rest << -0.5, 0.1, 0.2, 0.9, 0.1, 0;
    const pbs::BoneBinding binding = pbs::bind_to_nearest_bone(rest, limb);
    const pbs::Pose turned(2, Eigen::Isometry3d(Eigen::Translation3d(1, 2, 3) * Eigen::AngleAxisd(0.7, Vec3(1, 2, 2) / 3.0)));
    pbs::Positions moved(2, 3);
    for (int i = 0; i < 2; ++i) moved.row(i) = turned[0] * Vec3(rest.row(i));
    EXPECT_LT((pbs::reprojected_bind_points(binding, limb, turned, moved) - pbs::posed_bind_points(binding, turned)).norm(),
              std::sqrt(2.0) * motion_error(1 + 1 + 3, 5.0));  // of two points: the body, the points, and the projection on the moved bone
}

}  // namespace

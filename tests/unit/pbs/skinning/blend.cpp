// Reference: closed forms of two bones blended half and half. Tolerances: the rounding of motions, two for a linear blend and its closed
// form and three where rotations become quaternions and back.
#include "pbs/skinning/blend.hpp"

#include "tests/support/motion_rounding.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace {

using pbs::Positions;
using pbs::Vec3;
using test_support::motion_error;

constexpr double degree = std::numbers::pi / 180.0;

const pbs::Skeleton limb = {{{"upper", -1, {-1, 0, 0}, {0, 0, 0}}, {"forearm", 0, {0, 0, 0}, {1, 0, 0}}}};

pbs::Weights half_and_half()
{
    return {{0, 2}, {0, 1}, {0.5, 0.5}};
}

Positions blended_point(decltype(pbs::linear_blend_skinning) blend, const Vec3& point, const pbs::Weights& weights, const pbs::Pose& pose)
{
    Positions posed;
    blend(Positions(point.transpose()), weights, pose, posed);
    return posed;
}

pbs::Pose twisted(double angle_deg)
{
    return pbs::joint_sweep(limb, 1, Vec3::UnitX(), angle_deg, 2, 0.01).steps[1];
}

TEST(LinearBlendSkinning, ShrinksATwistByTheCosineOfHalfTheAngle)
{
    for (const double angle_deg : {10.0, 90.0, 150.0, 180.0}) {  // 180: the candy wrapper, radius zero
        const Positions posed = blended_point(pbs::linear_blend_skinning, {0, 0.2, 0}, half_and_half(), twisted(angle_deg));
        EXPECT_NEAR(posed.row(0).tail<2>().norm(), 0.2 * std::cos(angle_deg / 2 * degree), motion_error(2, 0.2)) << angle_deg;
    }
}

TEST(DualQuaternionSkinning, KeepsTheRadiusOfATwistAndHalvesItsAngle)
{
    for (const double angle_deg : {10.0, 90.0, 150.0, 179.0}) {
        const Positions posed = blended_point(pbs::dual_quaternion_skinning, {0, 0.2, 0}, half_and_half(), twisted(angle_deg));
        EXPECT_LT((posed.row(0).transpose() - 0.2 * Vec3(0, std::cos(angle_deg / 2 * degree), std::sin(angle_deg / 2 * degree))).norm(),
                  motion_error(3, 0.2))
            << angle_deg;
    }
}

TEST(DualQuaternionSkinning, BulgesWhereABendIsBlended)
{
    const pbs::Pose bent = pbs::joint_sweep(limb, 1, Vec3::UnitZ(), 90.0, 2, 0.01).steps[1];
    const Positions dqs = blended_point(pbs::dual_quaternion_skinning, {0, -0.2, 0}, half_and_half(), bent);
    const Positions lbs = blended_point(pbs::linear_blend_skinning, {0, -0.2, 0}, half_and_half(), bent);
    EXPECT_NEAR(dqs.row(0).norm(), 0.2, motion_error(3, 0.2));  // on a circle around the joint, where LBS cuts the corner
    EXPECT_NEAR(lbs.row(0).norm(), 0.2 * std::cos(45.0 * degree), motion_error(2, 0.2));
}

TEST(DualQuaternionSkinning, AgreesWithLinearBlendingWhereOneBoneMoves)
{
    const pbs::Pose pose = twisted(77.0);
    const pbs::Weights rigid = {{0, 1}, {1}, {1.0}};
    const Vec3 point(0.7, 0.1, -0.2);
    EXPECT_LT(
        (blended_point(pbs::dual_quaternion_skinning, point, rigid, pose) - blended_point(pbs::linear_blend_skinning, point, rigid, pose))
            .norm(),
        motion_error(3 + 1, point.norm()));
}

TEST(DualQuaternionSkinning, TakesTheShortWayForAntipodalQuaternions)
{
    // Rotations by 170 and -170 degrees are 20 degrees apart; their quaternions lie in opposite hemispheres.
    pbs::Pose pose(2, Eigen::Isometry3d::Identity());
    pose[0].linear() = Eigen::AngleAxisd(170.0 * degree, Vec3::UnitX()).toRotationMatrix();
    pose[1].linear() = Eigen::AngleAxisd(-170.0 * degree, Vec3::UnitX()).toRotationMatrix();
    const Positions posed = blended_point(pbs::dual_quaternion_skinning, {0, 1, 0}, half_and_half(), pose);
    EXPECT_LT((posed.row(0).transpose() - Vec3(0, -1, 0)).norm(), motion_error(3, 1.0));
}

TEST(DualQuaternionSkinning, PivotsOnTheHeaviestBone)
{
    // The first entry has no weight, so it must not determine the hemisphere of the others.
    pbs::Pose pose(3, Eigen::Isometry3d::Identity());
    pose[1].linear() = Eigen::AngleAxisd(100.0 * degree, Vec3::UnitX()).toRotationMatrix();
    pose[2].linear() = Eigen::AngleAxisd(-100.0 * degree, Vec3::UnitX()).toRotationMatrix();
    const pbs::Weights weights = {{0, 3}, {0, 1, 2}, {0.0, 0.5, 0.5}};
    const Positions posed = blended_point(pbs::dual_quaternion_skinning, {0, 1, 0}, weights, pose);
    EXPECT_LT((posed.row(0).transpose() - Vec3(0, -1, 0)).norm(), motion_error(3, 1.0));  // 180, between 100 and 260
}

TEST(Blends, LeaveTheRestPoseWhereItIs)
{
    const pbs::Pose rest(2, Eigen::Isometry3d::Identity());
    const Vec3 point(0.123, -0.456, 0.789);
    for (const auto blend : {pbs::linear_blend_skinning, pbs::dual_quaternion_skinning})
        EXPECT_EQ(blended_point(blend, point, half_and_half(), rest), Positions(point.transpose()));
}

TEST(Blends, OfNoVerticesAreEmpty)
{
    const pbs::Pose rest(2, Eigen::Isometry3d::Identity());
    for (const auto blend : {pbs::linear_blend_skinning, pbs::dual_quaternion_skinning}) {
        Positions posed(7, 3);
        blend(Positions(0, 3), pbs::Weights{{0}, {}, {}}, rest, posed);
        EXPECT_EQ(posed.rows(), 0);
    }
}

}  // namespace

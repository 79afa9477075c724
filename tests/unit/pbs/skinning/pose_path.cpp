// Reference: rigid kinematics. A joint is connected if parent and child move it to the same place; slerp rotates at a constant rate.
// Tolerances: the rounding of motions. A path takes three per joint: that of the pose, its inverse relative to the parent, and slerp.
#include "pbs/skinning/pose_path.hpp"

#include "tests/support/motion_rounding.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using pbs::PosePath;
using pbs::Vec3;

const pbs::Skeleton arm{{{"upper", -1, {0, 0, 0}, {1, 0, 0}}, {"fore", 0, {1, 0, 0}, {2, 0, 0}}, {"hand", 1, {2, 0, 0}, {2.5, 0, 0}}}};

Eigen::Quaterniond turn(double angle_deg, const Vec3& axis)
{
    return Eigen::Quaterniond(Eigen::AngleAxisd(angle_deg * std::acos(-1.0) / 180.0, axis.normalized()));
}

pbs::Pose pose(const Eigen::Quaterniond& upper, const Eigen::Quaterniond& fore, const Eigen::Quaterniond& hand, const Vec3& root)
{
    return pbs::pose_from_joints(arm, {upper, fore, hand}, root);
}

const pbs::Pose crouched = pose(turn(40, {1, 2, 0}), turn(100, {0, 1, 3}), turn(-70, {1, 1, 1}), {0.3, -2, 1});
const pbs::Pose stretched = pose(turn(-20, {0, 1, 0}), turn(5, {1, 0, 0}), turn(60, {0, 0, 1}), {1, 1, 1});

void expect_near(const pbs::Pose& a, const pbs::Pose& b)
{
    const double rounding = test_support::motion_matrix_error(3 * 3 + 3, 2.0);  // of three joints on a path, and of three others
    for (std::size_t j = 0; j < a.size(); ++j) EXPECT_LT((a[j].matrix() - b[j].matrix()).norm(), rounding) << arm.bones[j].name;
}

TEST(PosePath, ItsEndsAreThePosesToTheBit)
{
    const PosePath path(arm, crouched, stretched);
    for (std::size_t j = 0; j < arm.bones.size(); ++j) {
        EXPECT_EQ(path.at(0.0)[j].matrix(), crouched[j].matrix());
        EXPECT_EQ(path.at(1.0)[j].matrix(), stretched[j].matrix());
    }
}

TEST(PosePath, JointsStayJoinedAndBonesRigid)
{
    const PosePath path(arm, crouched, stretched);
    for (const double fraction : {0.1, 0.5, 0.77}) {
        const pbs::Pose between = path.at(fraction);
        for (std::size_t j = 1; j < arm.bones.size(); ++j) {
            const Vec3 joint = arm.bones[j].head;
            EXPECT_LT((between[j] * joint - between[arm.bones[j].parent] * joint).norm(), test_support::motion_error(3 * 3 + 3 * 2, 5.0));
        }
        for (const auto& bone : between)
            EXPECT_LT((bone.linear() * bone.linear().transpose() - Eigen::Matrix3d::Identity()).norm(),
                      test_support::motion_matrix_error(2 * 3 * 3, 0.0));
    }
}

TEST(PosePath, TurnsAtAnEvenRateAndTheShortWayRound)
{
    const Eigen::Quaterniond still = Eigen::Quaterniond::Identity();
    const pbs::Pose rest = pose(still, still, still, Vec3::Zero());
    expect_near(PosePath(arm, rest, pose(still, turn(80, Vec3::UnitZ()), still, Vec3::Zero())).at(0.25),
                pose(still, turn(20, Vec3::UnitZ()), still, Vec3::Zero()));
    expect_near(PosePath(arm, rest, pose(still, turn(270, Vec3::UnitZ()), still, Vec3::Zero())).at(0.5),
                pose(still, turn(-45, Vec3::UnitZ()), still, Vec3::Zero()));
}

TEST(PosePath, TheRootMovesInAStraightLine)
{
    const Eigen::Quaterniond still = Eigen::Quaterniond::Identity();
    const PosePath path(arm, pose(still, still, still, {1, 0, 0}), pose(turn(90, Vec3::UnitY()), still, still, {3, 4, 0}));
    EXPECT_LT((path.at(0.5)[0] * arm.bones[0].head - Vec3(2, 2, 0)).norm(), test_support::motion_error(3, 5.0));
}

// A clip may shift a bone relative to its parent: the head then moves at a constant rate in the parent's frame.
TEST(PosePath, AHeadThatLeavesItsParentMovesEvenly)
{
    pbs::Pose pulled(3, Eigen::Isometry3d::Identity());
    pulled[1].translation() = pulled[2].translation() = Vec3(0.4, 0, 0);
    const pbs::Pose half = PosePath(arm, pbs::Pose(3, Eigen::Isometry3d::Identity()), pulled).at(0.5);
    EXPECT_LT((half[1] * arm.bones[1].head - Vec3(1.2, 0, 0)).norm(), test_support::motion_error(2 * 3, 1.4));
    EXPECT_LT((half[2] * arm.bones[2].head - Vec3(2.2, 0, 0)).norm(), test_support::motion_error(3 * 3, 2.4));
}

TEST(PosePath, TheLargestTurnIsThatOfABoneInTheWorld)
{
    const Eigen::Quaterniond still = Eigen::Quaterniond::Identity();
    const pbs::Pose rest = pose(still, still, still, Vec3::Zero());
    const pbs::Pose bent = pose(still, turn(30, Vec3::UnitZ()), turn(25, Vec3::UnitZ()), Vec3::Zero());
    const double rounding = test_support::motion_matrix_error(3 + 1, 0.0);  // three joints, and the angle of a matrix
    EXPECT_NEAR(PosePath(arm, rest, bent).largest_turn_deg(), 55.0, rounding * 180.0 / std::acos(-1.0));
    EXPECT_EQ(PosePath(arm, bent, bent).largest_turn_deg(), 0.0);
}

}  // namespace

// Reference: a rigid motion and its inverse. Tolerances: the rounding of two motions, one of them on each side or both on one.
#include "pbs/skinning/pose_path.hpp"

#include "tests/support/motion_rounding.hpp"

#include <gtest/gtest.h>

namespace {

using pbs::RootFrame;
using pbs::Vec3;
using test_support::motion_error;

const pbs::Skeleton two_bones{{{"root", -1, {0, 0, 0}, {1, 0, 0}}, {"child", 0, {1, 0, 0}, {2, 0, 0}}}};
const Eigen::Isometry3d motion = Eigen::Translation3d(3, -1, 2) * Eigen::AngleAxisd(2.0, Vec3(1, 2, -3).normalized());

TEST(RootFrame, RemovesTheRootsMotionAndPutsItBack)
{
    const Eigen::Isometry3d bend(Eigen::AngleAxisd(0.5, Vec3::UnitZ()));
    const RootFrame frame(two_bones, {motion, motion * bend});
    const double rounding = test_support::motion_matrix_error(2, motion.translation().norm());
    EXPECT_LT((frame.pose()[0].matrix() - Eigen::Matrix4d::Identity()).norm(), rounding);
    EXPECT_LT((frame.pose()[1].matrix() - bend.matrix()).norm(), rounding);
    const Vec3 point(0.1, 0.2, 0.3);
    const pbs::Positions one = point.transpose();
    const double farthest = motion.translation().norm() + point.norm();
    EXPECT_LT((frame.to_world(one).row(0).transpose() - motion * point).norm(), motion_error(2, farthest));
    EXPECT_LT((frame.to_root(frame.to_world(one)) - one).norm(), motion_error(2, farthest));
}

TEST(RootFrame, TurnsDirectionsIntoItself)
{
    const RootFrame frame(two_bones, {motion, motion});
    const Vec3 gravity(0, -9.81, 1);
    EXPECT_LT((motion.linear() * frame.from_world(gravity) - gravity).norm(), motion_error(2, gravity.norm()));
}

}  // namespace

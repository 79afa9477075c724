// Reference: a rigid motion and its inverse.
#include "pbs/skinning/root_frame.hpp"

#include <gtest/gtest.h>

namespace {

using pbs::RootFrame;
using pbs::Vec3;

const pbs::Skeleton two_bones{{{"root", -1, {0, 0, 0}, {1, 0, 0}}, {"child", 0, {1, 0, 0}, {2, 0, 0}}}};
const Eigen::Isometry3d motion = Eigen::Translation3d(3, -1, 2) * Eigen::AngleAxisd(2.0, Vec3(1, 2, -3).normalized());

TEST(RootFrame, RemovesTheRootsMotionAndPutsItBack)
{
    const Eigen::Isometry3d bend(Eigen::AngleAxisd(0.5, Vec3::UnitZ()));
    const RootFrame frame(two_bones, {motion, motion * bend});
    EXPECT_LT((frame.pose()[0].matrix() - Eigen::Matrix4d::Identity()).norm(), 1e-14);
    EXPECT_LT((frame.pose()[1].matrix() - bend.matrix()).norm(), 1e-14);
    const Vec3 point(0.1, 0.2, 0.3);
    const pbs::Positions one = point.transpose();
    EXPECT_LT((frame.to_world(one).row(0).transpose() - motion * point).norm(), 1e-14);
    EXPECT_LT((frame.to_root(frame.to_world(one)) - one).norm(), 1e-14);
}

TEST(RootFrame, TurnsDirectionsIntoItself)
{
    const RootFrame frame(two_bones, {motion, motion});
    const Vec3 gravity(0, -9.81, 1);
    EXPECT_LT((motion.linear() * frame.from_world(gravity) - gravity).norm(), 1e-14);
}

}  // namespace

// Reference: Eq. 10 by hand. Tolerances: the rounding of a projection.
#include "pbs/constraints/stretch.hpp"

#include "tests/support/projection_rounding.hpp"

#include <gtest/gtest.h>

namespace {

using pbs::StretchConstraint;
using pbs::Vec3;

const StretchConstraint<double> rod{{0, 1}, 1.0, 1.0};

TEST(StretchConstraint, ValueIsLengthMinusRestLength)
{
    EXPECT_DOUBLE_EQ(value(rod, Vec3(0, 0, 0), Vec3(3, 0, 4)), 4.0);
    EXPECT_DOUBLE_EQ(value(rod, Vec3(1, 1, 1), Vec3(1, 1, 1.25)), -0.75);
}

TEST(StretchConstraint, ProjectionMeetsHalfWay)
{
    Vec3 p1(0, 0, 0), p2(3, 0, 0);
    project(rod, 1.0, 1.0, p1, p2);
    EXPECT_EQ(p1, Vec3(1, 0, 0));
    EXPECT_EQ(p2, Vec3(2, 0, 0));
}

TEST(StretchConstraint, ProjectionPushesACompressedEdgeApart)
{
    Vec3 p1(0, 0, 0), p2(0, 0.5, 0);
    project(rod, 1.0, 1.0, p1, p2);
    EXPECT_EQ(p1, Vec3(0, -0.25, 0));
    EXPECT_EQ(p2, Vec3(0, 0.75, 0));
}

TEST(StretchConstraint, APinnedPointLeavesTheWayToTheOther)
{
    Vec3 p1(0, 0, 0), p2(3, 0, 0);
    project(rod, 0.0, 1.0, p1, p2);
    EXPECT_EQ(p2, Vec3(1, 0, 0));
}

TEST(StretchConstraint, NearlyCoincidentPointsAreProjected)
{
    Vec3 p1(0, 0, 0), p2(1e-12, 0, 0);
    const double rounding_m = test_support::rounding_of(rod, 1.0, 1.0, p1, p2).step;  // of each end
    project(rod, 1.0, 1.0, p1, p2);
    EXPECT_NEAR((p2 - p1).norm(), 1.0, 2.0 * rounding_m);
}

}  // namespace

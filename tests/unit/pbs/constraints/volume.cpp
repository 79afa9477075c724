// Reference: Eq. 11 by hand. Tolerances: the rounding of a projection.
#include "pbs/constraints/volume.hpp"

#include "tests/support/projection_rounding.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/tet_corners.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using pbs::Vec3;
using pbs::VolumeConstraint;
using namespace test_support;

const VolumeConstraint<double> corner_tet{{0, 1, 2, 3}, 1.0 / 6.0, 1.0};
const CornerMasses<double> unit = {1.0, 1.0, 1.0, 1.0};
const Corners<double> at_rest = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};

double longest_edge(const Corners<double>& p)
{
    double longest = 0.0;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < i; ++j) longest = std::max(longest, (p[i] - p[j]).norm());
    return longest;
}

// The value that is left where projections have converged: the rounding of four corners, times the gradients, and that
// of ten operations on products of three edges.
double converged_error(const Corners<double>& p)
{
    double slope = 0.0;
    for (const Vec3& g : gradient_at(corner_tet, p)) slope += g.norm();
    return slope * rounding_of(corner_tet, unit, p).step + rounding_error(10, std::pow(longest_edge(p), 3) / 6.0);
}

TEST(VolumeConstraint, ValueIsSigned)
{
    EXPECT_DOUBLE_EQ(value_at(corner_tet, {at_rest[0], 2 * at_rest[1], at_rest[2], at_rest[3]}), 1.0 / 6.0);
    EXPECT_DOUBLE_EQ(value_at(corner_tet, {at_rest[0], at_rest[2], at_rest[1], at_rest[3]}), -1.0 / 3.0);
}

// C is linear in one corner, so one projection is exact.
TEST(VolumeConstraint, OneFreeCornerMeetsItAtOnce)
{
    Corners<double> p = at_rest;
    p[3].z() = 2.0;
    const CornerMasses<double> one_free = {0.0, 0.0, 0.0, 1.0};
    EXPECT_LT((projected(corner_tet, one_free, p)[3] - Vec3(0, 0, 1)).norm(),
              rounding_of(corner_tet, one_free, p).step);
}

TEST(VolumeConstraint, FlatTetIsInflated)
{
    Corners<double> p = at_rest;
    p[3] = Vec3(0.3, 0.3, 0.0);
    for (int i = 0; i < 10; ++i) p = projected(corner_tet, unit, p);
    EXPECT_NEAR(value_at(corner_tet, p), 0.0, converged_error(p));
}

// A possible error is to use |V|: a tet mirrored to -V0 counts as satisfied, and from -1.05 V0 the projection diverges.
TEST(VolumeConstraint, MirroredTetIsTurnedBack)
{
    for (const double mirrored : {-1.0, -1.05, -3.0}) {
        Corners<double> p = at_rest;
        p[3].z() = mirrored;
        EXPECT_LT(value_at(corner_tet, p), -0.33);
        for (int i = 0; i < 30; ++i) p = projected(corner_tet, unit, p);
        EXPECT_NEAR(value_at(corner_tet, p), 0.0, converged_error(p)) << mirrored;
    }
}

TEST(VolumeConstraint, RandomTetsConvergeOrStayFinite)
{
    RandomPoints random(7);
    int converged = 0;
    for (int trial = 0; trial < 1000; ++trial) {
        Corners<double> p = {random.point(1.0), random.point(1.0), random.point(1.0), random.point(1.0)};
        for (int i = 0; i < 50; ++i) p = projected(corner_tet, unit, p);
        EXPECT_TRUE(stacked(p).allFinite());
        converged += std::abs(value_at(corner_tet, p)) < converged_error(p);
    }
    EXPECT_GE(converged, 990);
}

}  // namespace

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

// The value that is left where projections have converged: the rounding of four corners, times the gradients, and that of ten operations on
// products of three edges.
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

// A possible error is to omit the factor 1/6 from the gradients but not from C, so that a projection at k = 1 removes only a sixth of the
// error. Our projection removes all of the linearised error. C is a cubic polynomial, so that the rest is d^T H d / 2 and the volume of the
// four displacements d, where |d| = |C| / |g|. The Hessian H of the volume consists of blocks of norm |edge| / 6, three in each row, and
// the differences of the displacements are at most sqrt 2 |d| long. The rest, relative to C, falls with the size of C.
TEST(VolumeConstraint, ProjectionLeavesASecondOrderErrorOnly)
{
    RandomPoints random(6);
    const Corners<double> shape = noisy_corner(random, 1.0);
    for (const double size : {1e-1, 1e-2, 1e-3, 1e-4}) {
        Corners<double> p = at_rest;
        for (int i = 0; i < 4; ++i) p[i] += size * shape[i];
        const double error = std::abs(value_at(corner_tet, p)), slope = stacked(gradient_at(corner_tet, p)).norm(), moved = error / slope;
        const double of_hessian = 3.0 * longest_edge(p) / 6.0 * moved * moved / 2.0, of_cubic = std::pow(std::sqrt(2.0) * moved, 3) / 6.0;
        EXPECT_LT(std::abs(value_at(corner_tet, projected(corner_tet, unit, p))), of_hessian + of_cubic + converged_error(p));
        EXPECT_LT(of_hessian + of_cubic, 4.0 * size * error) << "a bound that would let a part of the first order pass proves nothing";
    }
}

// C is linear in one corner, so one projection is exact.
TEST(VolumeConstraint, OneFreeCornerMeetsItAtOnce)
{
    Corners<double> p = at_rest;
    p[3].z() = 2.0;
    const CornerMasses<double> one_free = {0.0, 0.0, 0.0, 1.0};
    EXPECT_LT((projected(corner_tet, one_free, p)[3] - Vec3(0, 0, 1)).norm(), rounding_of(corner_tet, one_free, p).step);
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

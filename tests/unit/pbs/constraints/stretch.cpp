// Reference: Eq. 8-10 by hand; the gradient by an eps sweep. Tolerances: the rounding of a projection.
#include "pbs/constraints/stretch.hpp"

#include "tests/support/eps_sweep.hpp"
#include "tests/support/projection_rounding.hpp"
#include "tests/support/random_points.hpp"

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

TEST(StretchConstraint, GradientByEpsSweep)
{
    test_support::RandomPoints random(1);
    for (int trial = 0; trial < 20; ++trial) {
        const Vec3 p1 = random.point(1.0), p2 = p1 + Vec3(2, 0, 0) + random.point(1.0);
        Eigen::VectorXd x(6), direction(6);
        x << p1, p2;
        direction << random.point(1.0), random.point(1.0);
        const auto [g1, g2] = gradient(rod, p1, p2);
        const double slope = g1.dot(direction.head<3>()) + g2.dot(direction.tail<3>());
        const auto at = [](const Eigen::VectorXd& p) { return value(rod, Vec3(p.head<3>()), Vec3(p.tail<3>())); };
        test_support::expect_slope_by_eps_sweep(at, x, direction, slope, 1.0);
    }
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

TEST(StretchConstraint, ProjectionIsAStepAlongTheGradient)
{
    test_support::RandomPoints random(2);
    const StretchConstraint<double> soft{{0, 1}, 1.0, 0.3};
    const double w1 = 0.7, w2 = 2.5;
    for (int trial = 0; trial < 20; ++trial) {
        const Vec3 p1 = random.point(1.0), p2 = random.point(1.0);
        const auto [g1, g2] = gradient(soft, p1, p2);
        const double s = value(soft, p1, p2) / (w1 * g1.squaredNorm() + w2 * g2.squaredNorm());  // Eq. 9
        Vec3 moved_1 = p1, moved_2 = p2;
        project(soft, w1, w2, moved_1, moved_2);
        const double rounding_m = test_support::rounding_of(soft, w1, w2, p1, p2).step;
        EXPECT_LT((moved_1 - (p1 - 0.3 * s * w1 * g1)).norm(), rounding_m);  // Eq. 8
        EXPECT_LT((moved_2 - (p2 - 0.3 * s * w2 * g2)).norm(), rounding_m);
    }
}

TEST(StretchConstraint, StiffnessIsTheShareOfTheErrorRemoved)
{
    for (const double k : {0.0, 0.25, 0.5, 1.0}) {
        const StretchConstraint<double> soft{{0, 1}, 1.0, k};
        Vec3 p1(0, 0, 0), p2(1, 2, 2);
        const double rounding_m = test_support::rounding_of(soft, 1.0, 3.0, p1, p2).step;  // of each end
        project(soft, 1.0, 3.0, p1, p2);
        EXPECT_NEAR(value(soft, p1, p2), (1.0 - k) * 2.0, 2.0 * rounding_m);
    }
}

TEST(StretchConstraint, PinnedPointStays)
{
    Vec3 p1(0, 0, 0), p2(3, 0, 0);
    project(rod, 0.0, 1.0, p1, p2);
    EXPECT_EQ(p1, Vec3(0, 0, 0));
    EXPECT_EQ(p2, Vec3(1, 0, 0));
}

TEST(StretchConstraint, BothPinnedStay)
{
    Vec3 p1(0, 0, 0), p2(3, 0, 0);
    project(rod, 0.0, 0.0, p1, p2);
    EXPECT_EQ(p1, Vec3(0, 0, 0));
    EXPECT_EQ(p2, Vec3(3, 0, 0));
}

TEST(StretchConstraint, CoincidentPointsStay)
{
    Vec3 p1(1, 2, 3), p2(1, 2, 3);
    EXPECT_EQ(gradient(rod, p1, p2)[0], Vec3::Zero());
    project(rod, 1.0, 1.0, p1, p2);
    EXPECT_EQ(p1, Vec3(1, 2, 3));
    EXPECT_EQ(p2, Vec3(1, 2, 3));
}

TEST(StretchConstraint, NearlyCoincidentPointsAreProjected)
{
    Vec3 p1(0, 0, 0), p2(1e-12, 0, 0);
    const double rounding_m = test_support::rounding_of(rod, 1.0, 1.0, p1, p2).step;  // of each end
    project(rod, 1.0, 1.0, p1, p2);
    EXPECT_NEAR((p2 - p1).norm(), 1.0, 2.0 * rounding_m);
}

TEST(StretchConstraint, AtRestNothingMoves)
{
    Vec3 p1(0.1, 0.2, 0.3), p2(0.4, 0.7, 0.9);
    const Vec3 before_1 = p1, before_2 = p2;
    const StretchConstraint<double> at_rest{{0, 1}, value(StretchConstraint<double>{}, p1, p2), 1.0};
    project(at_rest, 1.0, 1.0, p1, p2);
    EXPECT_EQ(p1, before_1);
    EXPECT_EQ(p2, before_2);
}

}  // namespace

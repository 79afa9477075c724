// Reference: the conditions of the minimum, and a search over matrices of determinant one.
#include "pbs/flesh/projective_dynamics.hpp"

#include "pbs/geometry/nearest_rotation.hpp"
#include "tests/support/random_points.hpp"
#include "tests/support/rounding_error.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace {

using pbs::local_shapes;
using pbs::nearest_unit_product;
using pbs::Vec3;

Vec3 random_stretches(test_support::RandomPoints& random)
{
    Vec3 s(random.number(0.0, 3.0), random.number(0.0, 3.0), random.number(0.0, 3.0));
    std::sort(s.begin(), s.end(), std::greater<>());
    if (random.number(0.0, 1.0) < 0.5) s(2) *= -1.0;
    return s;
}

// The unknown is found to the last digit, and the product of three numbers of its size goes through some ten roundings. Where a double root
// makes it sensitive, its error appears squared in the product.
TEST(VolumeProjection, HasTheProductOneAndOneMultiplier)
{
    test_support::RandomPoints random(61);
    for (int i = 0; i < 2000; ++i) {
        const Vec3 s = random_stretches(random), nearest = nearest_unit_product(s);
        EXPECT_GT(nearest.minCoeff(), 0.0);
        EXPECT_NEAR(nearest.prod(), 1.0, test_support::rounding_error(40, 1.0) * (1.0 + nearest.maxCoeff() / nearest.minCoeff())) << s;
        const Vec3 multiplier = nearest.cwiseProduct(nearest - s);  // -kappa, three times
        const double rounding = test_support::rounding_error(10, nearest.maxCoeff() * (nearest.maxCoeff() + s.cwiseAbs().maxCoeff()));
        EXPECT_NEAR(multiplier(0), multiplier(2), rounding) << s;
        EXPECT_NEAR(multiplier(1), multiplier(2), rounding) << s;
    }
}

TEST(VolumeProjection, NoOtherNumbersOfProductOneAreNearer)
{
    test_support::RandomPoints random(62);
    for (int i = 0; i < 300; ++i) {
        const Vec3 s = random_stretches(random);
        const double distance = (nearest_unit_product(s) - s).norm();
        for (int other = 0; other < 200; ++other) {
            const double a = std::exp(random.number(-3.0, 3.0)), b = std::exp(random.number(-3.0, 3.0));
            EXPECT_GE((Vec3(a, b, 1.0 / (a * b)) - s).norm(), distance - test_support::rounding_error(40, 1.0 + s.norm())) << s;
        }
    }
}

TEST(VolumeProjection, KnownCases)
{
    const double rounding = test_support::rounding_error(20, 1.0);
    EXPECT_LT((nearest_unit_product({1, 1, 1}) - Vec3(1, 1, 1)).norm(), rounding);
    EXPECT_LT((nearest_unit_product({0, 0, 0}) - Vec3(1, 1, 1)).norm(), rounding);              // symmetric, volume zero
    EXPECT_LT((nearest_unit_product({0.5, 0.5, 0.5}) - Vec3(1, 1, 1)).norm(), rounding);        // symmetric, volume too small
    EXPECT_LT((nearest_unit_product({1.1, 1.1, 1.1}) - Vec3(1, 1, 1)).norm(), 10 * rounding);   // symmetric, volume too large
    EXPECT_LT((nearest_unit_product({2, 1, 0.5}) - Vec3(2, 1, 0.5)).norm(), 10 * rounding);     // of product one already
    EXPECT_LT(std::abs(nearest_unit_product({1, 1, -1}).prod() - 1.0), 10 * rounding);          // a reflection
    EXPECT_LT(std::abs(nearest_unit_product({1e-9, 1e-9, 1e-9}).prod() - 1.0), 10 * rounding);  // collapsed
    EXPECT_LT(std::abs(nearest_unit_product({1e3, 1e3, 1e3}).prod() - 1.0), 1e-9);              // blown up: large over small
}

TEST(VolumeProjection, OfAMatrixTurnsWithIt)
{
    test_support::RandomPoints random(63);
    for (int i = 0; i < 200; ++i) {
        Eigen::Matrix3d f = Eigen::Matrix3d::Identity();
        for (double& entry : f.reshaped()) entry += random.number(-0.4, 0.4);
        const Eigen::Matrix3d turn = random.rigid_motion(0.0).linear();
        const pbs::LocalShapes here = local_shapes(f), there = local_shapes(turn * f);
        EXPECT_NEAR(here.unit_volume.determinant(), 1.0, test_support::rounding_error(100, here.unit_volume.cwiseAbs().prod() + 6.0));
        EXPECT_LT((there.rotation - turn * here.rotation).norm(), 1e-12);
        EXPECT_LT((there.unit_volume - turn * here.unit_volume).norm(), 1e-12);
    }
}

TEST(VolumeProjection, NotFiniteIsNoShape)
{
    Eigen::Matrix3d f = Eigen::Matrix3d::Identity();
    f(0, 1) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(local_shapes(f).unit_volume.array().isNaN().all());
}

}  // namespace

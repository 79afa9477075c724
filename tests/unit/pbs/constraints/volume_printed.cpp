// Reference: Eq. 12-20 as printed, and the gradients that finite differences confirm (constraints/volume).
#include "pbs/constraints/volume_printed.hpp"

#include "tests/support/eps_sweep.hpp"
#include "tests/support/tet_corners.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using pbs::Printed;
using pbs::Vec3;
using pbs::VolumeConstraint;
using namespace test_support;

const VolumeConstraint<double> corner_tet{{0, 1, 2, 3}, 1.0 / 6.0, 1.0};

template <Printed form>
Corners<double> printed_at(const Corners<double>& p)
{
    return pbs::gradient_printed<form>(corner_tet, p[0], p[1], p[2], p[3]);
}

template <Printed form>
Corners<double> projected_printed(Corners<double> p)
{
    pbs::project_printed<form>(corner_tet, p[0], p[1], p[2], p[3]);
    return p;
}

// The difference between g . direction and the slope by finite differences.
double slope_error(const Corners<double>& g, const Corners<double>& p, const Eigen::VectorXd& direction)
{
    const double h = 1e-5;
    const Eigen::VectorXd x = stacked(p);
    const double slope =
        (value_at(corner_tet, unstacked(x + h * direction)) - value_at(corner_tet, unstacked(x - h * direction))) / (2.0 * h);
    return std::abs(stacked(g).dot(direction) - slope);
}

TEST(VolumePrinted, LabelsAreTheDerivedGradientsUnderTheWrongParticles)
{
    RandomPoints random(11);
    const Corners<double> p = noisy_corner(random, 0.3), g = gradient_at(corner_tet, p), printed = printed_at<Printed::labels_relative>(p);
    EXPECT_NEAR((printed[1] - g[3]).norm(), 0.0, 1e-16);  // Eq. 12
    EXPECT_NEAR((printed[2] - g[1]).norm(), 0.0, 1e-16);  // Eq. 13
    EXPECT_NEAR((printed[3] - g[2]).norm(), 0.0, 1e-16);  // Eq. 14
}

TEST(VolumePrinted, SumOfTheAbsoluteProductsIsTranslationInvariant)
{
    RandomPoints random(12);
    const Corners<double> p = noisy_corner(random, 0.3);
    Corners<double> moved = p;
    for (Vec3& corner : moved) corner += Vec3(3, -2, 5);
    const Vec3 derived = gradient_at(corner_tet, p)[0];
    EXPECT_NEAR((printed_at<Printed::labels_absolute>(p)[0] - derived).norm(), 0.0, 1e-15);  // Eq. 15-16 are correct
    EXPECT_NEAR((printed_at<Printed::labels_absolute>(moved)[0] - derived).norm(), 0.0, 1e-14);
    EXPECT_GT((printed_at<Printed::labels_absolute>(moved)[1] - printed_at<Printed::labels_absolute>(p)[1]).norm(), 0.1);  // Eq. 12 is not
}

TEST(VolumePrinted, FiniteDifferencesContradictTheLabels)
{
    RandomPoints random(13);
    double derived = 0.0, relative = 1e9, absolute = 1e9, sign = 0.0;
    for (int trial = 0; trial < 20; ++trial) {
        const Corners<double> p = noisy_corner(random, 0.1);
        const Eigen::VectorXd direction = stacked(noisy_corner(random, 0.2));
        derived = std::max(derived, slope_error(gradient_at(corner_tet, p), p, direction));
        sign = std::max(sign, slope_error(printed_at<Printed::sign>(p), p, direction));
        relative = std::min(relative, slope_error(printed_at<Printed::labels_relative>(p), p, direction));
        absolute = std::min(absolute, slope_error(printed_at<Printed::labels_absolute>(p), p, direction));
    }
    EXPECT_LT(derived, 1e-9);  // h^2 and rounding / h
    EXPECT_LT(sign, 1e-9);     // here the gradient is correct, and Eq. 17-20 are not
    EXPECT_GT(relative, 1e-2);
    EXPECT_GT(absolute, 1e-2);
}

TEST(VolumePrinted, SignMovesAwayFromTheRestVolume)
{
    RandomPoints random(14);
    for (int trial = 0; trial < 20; ++trial) {
        const Corners<double> p = noisy_corner(random, 0.01);
        const double before = value_at(corner_tet, p), after = value_at(corner_tet, projected_printed<Printed::sign>(p));
        EXPECT_NEAR(after / before, 2.0, 0.2);  // the error is doubled, to first order
    }
}

TEST(VolumePrinted, DegenerateTetsStay)
{
    const Corners<double> point = {Vec3(1, 2, 3), Vec3(1, 2, 3), Vec3(1, 2, 3), Vec3(1, 2, 3)};
    EXPECT_EQ(projected_printed<Printed::sign>(point), point);
    EXPECT_EQ(projected_printed<Printed::labels_relative>(point), point);
    EXPECT_EQ(projected_printed<Printed::labels_absolute>(point), point);
}

}  // namespace

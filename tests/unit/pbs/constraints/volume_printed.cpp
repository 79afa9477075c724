// Reference: Eq. 12-20 as printed, and the gradients that finite differences confirm (constraints/volume).
#include "pbs/constraints/volume_printed.hpp"

#include "tests/support/eps_sweep.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/tet_corners.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace volume_printed_tests {
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
        (value_at(corner_tet, unstacked(x + h * direction)) - value_at(corner_tet, unstacked(x - h * direction))) /
        (2.0 * h);
    return std::abs(stacked(g).dot(direction) - slope);
}

// The rounding of two evaluations of a cross product over 6 of vectors of that length: an entry goes through five
// roundings, of two differences, a product, a sum and the division, and the magnitudes of the six products have the
// norm sqrt 2 times the squared length.
double cross_product_error(double roundings_of_sums, double length)
{
    return rounding_error(2 * (5 + roundings_of_sums), std::sqrt(2.0) * length * length / 6.0);
}

double largest_norm(const Corners<double>& p, const Vec3& origin)
{
    return std::max({(p[0] - origin).norm(), (p[1] - origin).norm(), (p[2] - origin).norm(), (p[3] - origin).norm()});
}

TEST(VolumePrinted, LabelsAreTheDerivedGradientsUnderTheWrongParticles)
{
    RandomPoints random(11);
    const Corners<double> p = noisy_corner(random, 0.3), g = gradient_at(corner_tet, p),
                          printed = printed_at<Printed::labels_relative>(p);
    const double rounding = cross_product_error(0, largest_norm(p, p[0]));
    EXPECT_NEAR((printed[1] - g[3]).norm(), 0.0, rounding);  // Eq. 12
    EXPECT_NEAR((printed[2] - g[1]).norm(), 0.0, rounding);  // Eq. 13
    EXPECT_NEAR((printed[3] - g[2]).norm(), 0.0, rounding);  // Eq. 14
}

// Three products are added, in three sums with those of the gradients; moving the corners rounds the two factors of a
// product.
TEST(VolumePrinted, SumOfTheAbsoluteProductsIsTranslationInvariant)
{
    RandomPoints random(12);
    const Corners<double> p = noisy_corner(random, 0.3);
    Corners<double> moved = p;
    for (Vec3& corner : moved) corner += Vec3(3, -2, 5);
    const Vec3 derived = gradient_at(corner_tet, p)[0];
    const auto rounding = [](const Corners<double>& at) {
        return 3.0 * cross_product_error(3 + 1, largest_norm(at, Vec3::Zero()));
    };
    // Eq. 15-16 are correct.
    EXPECT_NEAR((printed_at<Printed::labels_absolute>(p)[0] - derived).norm(), 0.0, rounding(p));
    EXPECT_NEAR((printed_at<Printed::labels_absolute>(moved)[0] - derived).norm(), 0.0, rounding(moved));
    // Eq. 12 is not
    EXPECT_GT((printed_at<Printed::labels_absolute>(moved)[1] - printed_at<Printed::labels_absolute>(p)[1]).norm(),
              0.1);
}

TEST(VolumePrinted, FiniteDifferencesContradictTheLabels)
{
    RandomPoints random(13);
    double relative = 1e9, absolute = 1e9;
    const auto at = [](const Eigen::VectorXd& x) { return value_at(corner_tet, unstacked(x)); };
    for (int trial = 0; trial < 20; ++trial) {
        const Corners<double> p = noisy_corner(random, 0.1);
        const Eigen::VectorXd direction = stacked(noisy_corner(random, 0.2));
        expect_slope_by_eps_sweep(at, stacked(p), direction, stacked(gradient_at(corner_tet, p)).dot(direction), 1.0);
        // Here the gradient is correct, and Eq. 17-20 are not.
        expect_slope_by_eps_sweep(at, stacked(p), direction, stacked(printed_at<Printed::sign>(p)).dot(direction), 1.0);
        relative = std::min(relative, slope_error(printed_at<Printed::labels_relative>(p), p, direction));
        absolute = std::min(absolute, slope_error(printed_at<Printed::labels_absolute>(p), p, direction));
    }
    EXPECT_GT(relative, 1e-2);  // the difference quotient itself is in error by h^2 and rounding / h, some 1e-10
    EXPECT_GT(absolute, 1e-2);
}

// The error is doubled, to first order. The second order is at most |C| |H| / (2 |g|^2) of it
// (StiffnessIsTheShareOfTheErrorRemoved), and |C| <= 0.01 sqrt 3 sum |g_i| = 0.0137 m^3; |H| = 0.71 m and |g|^2 = 1/6
// m^4 themselves are those of the unit corner to some 10 %.
TEST(VolumePrinted, SignMovesAwayFromTheRestVolume)
{
    RandomPoints random(14);
    for (int trial = 0; trial < 20; ++trial) {
        const Corners<double> p = noisy_corner(random, 0.01);
        const double before = value_at(corner_tet, p),
                     after = value_at(corner_tet, projected_printed<Printed::sign>(p));
        EXPECT_NEAR(after / before, 2.0, 1.1 * 0.0137 * 0.71 / (2.0 / 6.0));
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
}  // namespace volume_printed_tests

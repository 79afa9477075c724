// Reference: the definition of the polar decomposition, F = R S with R a rotation and S symmetric. For its derivative: R does not depend on
// the scale of F or on a stretch along its own axes, and rotates with F.
#include "reference_fem/laws/polar_decomposition.hpp"

#include "reference_fem/laws/matrix_calculus.hpp"
#include "tests/support/law_points.hpp"

#include <Eigen/LU>

namespace {

using namespace reference_fem;
using namespace test_support;

void expect_polar(const Eigen::Matrix3d& f)
{
    const PolarDecomposition polar = polar_decomposition(f);
    const double rounding = 1e-14 * f.norm();
    const Eigen::Matrix3d stretch = polar.rotation.transpose() * f;
    EXPECT_LE((polar.rotation.transpose() * polar.rotation - Eigen::Matrix3d::Identity()).norm(), 1e-14);
    EXPECT_NEAR(polar.rotation.determinant(), 1.0, 1e-14);
    EXPECT_LE((stretch - stretch.transpose()).norm(), rounding);
    EXPECT_NEAR(stretch.trace(), polar.stretches.sum(), rounding);
    EXPECT_GE(polar.stretches(1) + polar.stretches(2), -rounding);
}

TEST(PolarDecomposition, IsARotationTimesASymmetricStretch)
{
    RandomPoints random(2);
    for (int i = 0; i < 20; ++i) {
        expect_polar(random_stretch(random));
        expect_polar(random_inversion(random));
        expect_polar(random_rotation(random));
    }
}

TEST(PolarDecomposition, HoldsWhereFDegenerates)
{
    RandomPoints random(3);
    const Eigen::Matrix3d q = random_rotation(random);
    for (const Eigen::Vector3d& stretches : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(2, 1, 0),
                                             Eigen::Vector3d(1, 1, -1), Eigen::Vector3d(-1, -1, -1), Eigen::Vector3d(1e8, 1, 1e-8)})
        expect_polar(q * stretches.asDiagonal());
}

TEST(RotationDerivative, VanishesAlongStretchesAndFollowsSpins)
{
    RandomPoints random(4);
    for (const Eigen::Matrix3d& f : {random_stretch(random), random_inversion(random)}) {
        const PolarDecomposition polar = polar_decomposition(f);
        const Tangent derivative = rotation_derivative(polar);
        const Eigen::Matrix3d a = random_matrix(random, 1.0), symmetric = a + a.transpose(), skew = a - a.transpose();
        EXPECT_LE((derivative * vec(polar.rotation * symmetric)).norm(), 1e-14 * a.norm());
        EXPECT_LE((derivative * vec(skew * f) - vec(skew * polar.rotation)).norm(), 1e-13 * a.norm());
    }
}

}  // namespace

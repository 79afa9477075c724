// Reference: the definition of the polar decomposition, F = R S with R a rotation and S symmetric. For its derivative: R does not depend on
// the scale of F or on a stretch along its own axes, and rotates with F.
// Tolerances: Jacobi's method takes at most five sweeps of three pairs, each pair a rotation from the left and one from the right, so that
// an entry of R goes through 30 rotations of six roundings. Roundings of random sign add up to the square root of their number (N. Higham,
// Accuracy and stability of numerical algorithms, 2nd ed., SIAM 2002, Sec. 2.8); the Frobenius norm of nine entries is three times as
// large.
#include "reference_fem/laws/polar_decomposition.hpp"

#include "reference_fem/laws/matrix_calculus.hpp"
#include "tests/support/law_points.hpp"
#include "tests/support/rounding_error.hpp"

#include <Eigen/LU>

#include <cmath>

namespace {

using namespace reference_fem;
using namespace test_support;

const double of_rotations = 3.0 * rounding_error(std::sqrt(30.0 * 6.0), 1.0);  // the error of R, and of U S V^T relative to F

// The products and the determinant contain R twice or thrice in directions of norm one. The stretch contains both errors, and its
// asymmetry contains it twice.
void expect_polar(const Eigen::Matrix3d& f)
{
    const PolarDecomposition polar = polar_decomposition(f);
    const Eigen::Matrix3d stretch = polar.rotation.transpose() * f;
    EXPECT_LE((polar.rotation.transpose() * polar.rotation - Eigen::Matrix3d::Identity()).norm(), 2.0 * of_rotations);
    EXPECT_NEAR(polar.rotation.determinant(), 1.0, std::sqrt(3.0) * of_rotations);
    EXPECT_LE((stretch - stretch.transpose()).norm(), 4.0 * of_rotations * f.norm());
    EXPECT_NEAR(stretch.trace(), polar.stretches.sum(), std::sqrt(3.0) * 2.0 * of_rotations * f.norm());
    EXPECT_GE(polar.stretches(1) + polar.stretches(2), 0.0);  // singular values are sorted, and only the sign of the last one changes
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

// The derivative, of norm 2 / (s_2 + s_3), contains the axes twice, and its argument and what it is compared with contain R.
TEST(RotationDerivative, VanishesAlongStretchesAndFollowsSpins)
{
    RandomPoints random(4);
    for (const Eigen::Matrix3d& f : {random_stretch(random), random_inversion(random)}) {
        const PolarDecomposition polar = polar_decomposition(f);
        const Tangent derivative = rotation_derivative(polar);
        const Eigen::Matrix3d a = random_matrix(random, 1.0), symmetric = a + a.transpose(), skew = a - a.transpose();
        const double rounding = 4.0 * of_rotations * 2.0 / (polar.stretches(1) + polar.stretches(2));
        EXPECT_LE((derivative * vec(polar.rotation * symmetric)).norm(), rounding * symmetric.norm());
        EXPECT_LE((derivative * vec(skew * f) - vec(skew * polar.rotation)).norm(), rounding * skew.norm() * f.norm());
    }
}

}  // namespace

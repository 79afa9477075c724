#include "reference_fem/laws/polar_decomposition.hpp"

#include "reference_fem/laws/matrix_calculus.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>

#include <algorithm>

namespace reference_fem {

PolarDecomposition polar_decomposition(const Eigen::Matrix3d& f)
{
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(f, Eigen::ComputeFullU | Eigen::ComputeFullV);
    PolarDecomposition polar{svd.matrixU(), svd.matrixV(), svd.singularValues(), {}};
    polar.rotation.noalias() = polar.left * polar.right.transpose();
    if (polar.rotation.determinant() < 0.0) {
        polar.left.col(2) *= -1.0;
        polar.stretches(2) *= -1.0;
        polar.rotation.noalias() = polar.left * polar.right.transpose();
    }
    return polar;
}

Tangent rotation_derivative(const PolarDecomposition& polar)
{
    const double lowest_sum = 1e-8 * std::max(1.0, polar.stretches(0));
    Tangent derivative = Tangent::Zero();
    for (int k = 0; k < 3; ++k) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        const Eigen::Matrix3d twist =
            polar.left.col(j) * polar.right.col(i).transpose() - polar.left.col(i) * polar.right.col(j).transpose();
        const double sum = std::max(polar.stretches(i) + polar.stretches(j), lowest_sum);
        derivative += outer(twist, twist) / sum;
    }
    return derivative;
}

}  // namespace reference_fem

#include "reference_fem/laws/matrix_calculus.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>

#include <algorithm>
#include <cmath>

namespace reference_fem {
namespace {

// [a]x b = a x b
Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& a)
{
    Eigen::Matrix3d matrix;
    matrix << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
    return matrix;
}

}  // namespace

Eigen::Matrix3d cofactor(const Eigen::Matrix3d& f)
{
    Eigen::Matrix3d result;
    for (int j = 0; j < 3; ++j) result.col(j) = f.col((j + 1) % 3).cross(f.col((j + 2) % 3));
    return result;
}

Tangent cofactor_derivative(const Eigen::Matrix3d& f)
{
    Tangent result = Tangent::Zero();
    for (int j = 0; j < 3; ++j) {  // column j is f_k x f_l
        const int k = (j + 1) % 3, l = (j + 2) % 3;
        result.block<3, 3>(3 * j, 3 * k) = -cross_matrix(f.col(l));
        result.block<3, 3>(3 * j, 3 * l) = cross_matrix(f.col(k));
    }
    return result;
}

Tangent transposing_product(const Eigen::Matrix3d& a)
{
    Tangent result;
    for (int j = 0; j < 3; ++j)
        for (int l = 0; l < 3; ++l) result.block<3, 3>(3 * j, 3 * l) = a.col(l) * a.col(j).transpose();
    return result;
}

double Invariants::log_volume() const
{
    return std::abs(volume_change) < 0.5 ? std::log1p(volume_change) : std::log(volume);
}

Invariants invariants(const Eigen::Matrix3d& f)
{
    const Eigen::Matrix3d g = f - Eigen::Matrix3d::Identity();
    double second = 0.0;  // of the principal invariants: the sum of the principal minors
    for (int i = 0, j = 1; i < 3; ++i, j = (j + 1) % 3) second += g(i, i) * g(j, j) - g(i, j) * g(j, i);
    const double trace = g.trace(), determinant = g.determinant(), squared_norm = g.squaredNorm();
    return {f.determinant(), trace + second + determinant, 2.0 * trace + squared_norm, 0.5 * squared_norm - second - determinant};
}

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

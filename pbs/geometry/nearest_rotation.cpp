#include "pbs/geometry/nearest_rotation.hpp"

#include "pbs/geometry/rotation_formula.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>

#include <limits>

namespace pbs {
namespace {

template <class Scalar>
bool by_formula(const Eigen::Matrix<Scalar, 3, 3>& matrix, Eigen::Matrix<Scalar, 3, 3>& rotation)
{
    using namespace rotation_formula;
    using Rows = Eigen::Matrix<Scalar, 3, 3, Eigen::RowMajor>;
    Matrix3<Scalar> from, to;
    Eigen::Map<Rows>(from.m) = matrix;
    const Scalar determinant = nearest(from, largest_correction<Scalar>, to);
    rotation = Eigen::Map<const Rows>(to.m);
    return determinant > least_determinant<Scalar>;
}

}  // namespace

Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& matrix)
{
    Eigen::Matrix3d rotation;
    return by_formula(matrix, rotation) ? rotation : nearest_rotation_by_svd(matrix);
}

Eigen::Matrix3f nearest_rotation(const Eigen::Matrix3f& matrix)
{
    Eigen::Matrix3f rotation;
    if (by_formula(matrix, rotation)) return rotation;
    return nearest_rotation(Eigen::Matrix3d(matrix.cast<double>())).cast<float>();
}

Eigen::Matrix3d nearest_rotation_by_svd(const Eigen::Matrix3d& matrix)
{
    if (!matrix.allFinite()) return Eigen::Matrix3d::Constant(std::numeric_limits<double>::quiet_NaN());
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Matrix3d u = svd.matrixU();
    if ((u * svd.matrixV().transpose()).determinant() < 0.0) u.col(2) *= -1.0;
    return u * svd.matrixV().transpose();
}

}  // namespace pbs

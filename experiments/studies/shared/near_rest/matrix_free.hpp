// A linear map as Eigen's iterative solvers take it: a product instead of a matrix.
//   const MatrixFree matrix(n, [](const Eigen::VectorXd& x) -> Eigen::VectorXd { ... });
//   Eigen::GMRES<MatrixFree, Eigen::IdentityPreconditioner> gmres(matrix);
#pragma once

#include <Eigen/SparseCore>

#include <functional>
#include <utility>

namespace experiments {
class MatrixFree;
}

template <>
struct Eigen::internal::traits<experiments::MatrixFree> : Eigen::internal::traits<Eigen::SparseMatrix<double>> {
};

namespace experiments {

class MatrixFree : public Eigen::EigenBase<MatrixFree> {
public:
    using Scalar = double;
    using RealScalar = double;
    using StorageIndex = int;
    enum { ColsAtCompileTime = Eigen::Dynamic, MaxColsAtCompileTime = Eigen::Dynamic, IsRowMajor = false };
    using Map = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;

    MatrixFree(Eigen::Index size, Map map) : size_(size), map_(std::move(map)) {}

    Eigen::Index rows() const { return size_; }
    Eigen::Index cols() const { return size_; }
    Eigen::VectorXd apply(const Eigen::VectorXd& vector) const { return map_(vector); }

    template <typename Vector>
    Eigen::Product<MatrixFree, Vector, Eigen::AliasFreeProduct> operator*(const Eigen::MatrixBase<Vector>& vector) const
    {
        return {*this, vector.derived()};
    }

private:
    Eigen::Index size_;
    Map map_;
};

}  // namespace experiments

template <typename Vector>
struct Eigen::internal::generic_product_impl<experiments::MatrixFree, Vector, Eigen::SparseShape, Eigen::DenseShape, Eigen::GemvProduct>
    : generic_product_impl_base<experiments::MatrixFree, Vector, generic_product_impl<experiments::MatrixFree, Vector>> {
    template <typename Target>
    static void scaleAndAddTo(Target& target, const experiments::MatrixFree& matrix, const Vector& vector, const double& scale)
    {
        target.noalias() += scale * matrix.apply(vector);
    }
};

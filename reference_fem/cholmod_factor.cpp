// CHOLMOD: Y. Chen, T. Davis, W. Hager, S. Rajamanickam, Algorithm 887, ACM TOMS 35(3), 2008.
#include "pbs/geometry/cost.hpp"
#include "reference_fem/linear_solvers.hpp"

#include <cholmod.h>

#include <algorithm>
#include <array>
#include <limits>

namespace reference_fem {
namespace {

static_assert(sizeof(SuiteSparse_long) == sizeof(SparseMatrix::StorageIndex));

// CHOLMOD's view of the upper triangle, without a copy.
cholmod_sparse view(const SparseMatrix& matrix)
{
    cholmod_sparse sparse{};
    sparse.nrow = matrix.rows();
    sparse.ncol = matrix.cols();
    sparse.nzmax = matrix.nonZeros();
    sparse.p = const_cast<SparseMatrix::StorageIndex*>(matrix.outerIndexPtr());
    sparse.i = const_cast<SparseMatrix::StorageIndex*>(matrix.innerIndexPtr());
    sparse.x = const_cast<double*>(matrix.valuePtr());
    sparse.stype = 1;
    sparse.itype = CHOLMOD_LONG;
    sparse.xtype = CHOLMOD_REAL;
    sparse.dtype = CHOLMOD_DOUBLE;
    sparse.sorted = 1;
    sparse.packed = 1;
    return sparse;
}

cholmod_dense view(const Eigen::VectorXd& vector)
{
    cholmod_dense dense{};
    dense.nrow = dense.d = dense.nzmax = vector.size();
    dense.ncol = 1;
    dense.x = const_cast<double*>(vector.data());
    dense.xtype = CHOLMOD_REAL;
    dense.dtype = CHOLMOD_DOUBLE;
    return dense;
}

class CholmodFactor : public PreparedSolver {
public:
    explicit CholmodFactor(const SparseMatrix& matrix) : matrix_(matrix)
    {
        cholmod_l_start(&common_);
        common_.print = 0;
        common_.supernodal = CHOLMOD_SUPERNODAL;
        // CHOLMOD's own strategy of ordering: AMD, and METIS besides where AMD's factor is large; the smaller one is taken.
        // Supernodes are merged more than by default: a tenth more zeros, a quarter less time on 7K dofs, a tenth less on 50K.
        std::copy_n(std::array{16, 48, 96}.begin(), 3, common_.nrelax);
        std::copy_n(std::array{0.9, 0.3, 0.1}.begin(), 3, common_.zrelax);
        cholmod_sparse sparse = view(matrix);
        const pbs::Stopwatch analysis;
        factor_ = cholmod_l_analyze(&sparse, &common_);
        analyse_s_ = analysis.seconds();
        refactor();
    }

    void refactor() final
    {
        usable_ = false;
        if (!factor_) return;
        cholmod_sparse sparse = view(matrix_);
        const pbs::Stopwatch factorisation;
        cholmod_l_factorize(&sparse, factor_, &common_);
        factor_s_ = factorisation.seconds();
        if (common_.status != CHOLMOD_OK || factor_->minor < factor_->n) return;  // not positive definite
        reciprocal_condition_ = cholmod_l_rcond(factor_, &common_);
        usable_ = reciprocal_condition_ > std::numeric_limits<double>::epsilon();
    }

    ~CholmodFactor() override
    {
        for (cholmod_dense** dense : {&solution_, &work_, &permuted_})
            if (*dense) cholmod_l_free_dense(dense, &common_);
        if (factor_) cholmod_l_free_factor(&factor_, &common_);
        cholmod_l_finish(&common_);
    }

    CholmodFactor(const CholmodFactor&) = delete;
    CholmodFactor& operator=(const CholmodFactor&) = delete;

    Eigen::VectorXd solve(const Eigen::VectorXd& right_hand_side) const override
    {
        cholmod_dense dense = view(right_hand_side);
        if (!cholmod_l_solve2(CHOLMOD_A, factor_, &dense, nullptr, &solution_, nullptr, &work_, &permuted_, &common_))
            return Eigen::VectorXd::Constant(right_hand_side.size(), std::numeric_limits<double>::quiet_NaN());
        return Eigen::Map<const Eigen::VectorXd>(static_cast<const double*>(solution_->x), right_hand_side.size());
    }

    std::string name() const override
    {
        int version[3];
        cholmod_l_version(version);
        return "CHOLMOD " + std::to_string(version[0]) + "." + std::to_string(version[1]) + "." + std::to_string(version[2]) +
               (factor_ && factor_->ordering == CHOLMOD_METIS ? " supernodal, METIS" : " supernodal, AMD");
    }

private:
    const SparseMatrix& matrix_;
    mutable cholmod_common common_;
    cholmod_factor* factor_ = nullptr;
    mutable cholmod_dense *solution_ = nullptr, *work_ = nullptr, *permuted_ = nullptr;
};

}  // namespace

std::unique_ptr<PreparedSolver> prepare_cholmod(const SparseMatrix& matrix)
{
    return std::make_unique<CholmodFactor>(matrix);
}

}  // namespace reference_fem

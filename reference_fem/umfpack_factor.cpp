// UMFPACK: T. Davis, Algorithm 832, ACM TOMS 30(2), 2004. It knows nothing of symmetry: a second opinion on the same matrix.
#include "pbs/geometry/cost.hpp"
#include "reference_fem/linear_solvers.hpp"

#include <umfpack.h>

#include <limits>

namespace reference_fem {
namespace {

class UmfpackFactor : public PreparedSolver {
public:
    explicit UmfpackFactor(const SparseMatrix& matrix) : matrix_(matrix)
    {
        umfpack_dl_defaults(control_);
        control_[UMFPACK_STRATEGY] = UMFPACK_STRATEGY_SYMMETRIC;
        control_[UMFPACK_ORDERING] = UMFPACK_ORDERING_METIS;  // half the fill and time of AMD on P2
        control_[UMFPACK_IRSTEP] = 0;                         // refinement took thrice the time for half the residual
        const pbs::Stopwatch analysis;
        umfpack_dl_symbolic(matrix.rows(), matrix.cols(), columns(), rows(), matrix.valuePtr(), &symbolic_, control_, nullptr);
        analyse_s_ = analysis.seconds();
        refactor();
    }

    void refactor() final
    {
        usable_ = false;
        if (!symbolic_) return;
        if (numeric_) umfpack_dl_free_numeric(&numeric_);
        double info[UMFPACK_INFO] = {};
        const pbs::Stopwatch factorisation;
        const auto status = umfpack_dl_numeric(columns(), rows(), matrix_.valuePtr(), symbolic_, &numeric_, control_, info);
        factor_s_ = factorisation.seconds();
        reciprocal_condition_ = info[UMFPACK_RCOND];
        usable_ = status == UMFPACK_OK && reciprocal_condition_ > std::numeric_limits<double>::epsilon();
    }

    ~UmfpackFactor() override
    {
        if (numeric_) umfpack_dl_free_numeric(&numeric_);
        if (symbolic_) umfpack_dl_free_symbolic(&symbolic_);
    }

    UmfpackFactor(const UmfpackFactor&) = delete;
    UmfpackFactor& operator=(const UmfpackFactor&) = delete;

    Eigen::VectorXd solve(const Eigen::VectorXd& right_hand_side) const override
    {
        Eigen::VectorXd solution(right_hand_side.size());
        const auto status = umfpack_dl_solve(UMFPACK_A, columns(), rows(), matrix_.valuePtr(), solution.data(), right_hand_side.data(),
                                             numeric_, control_, nullptr);
        if (status != UMFPACK_OK) solution.setConstant(std::numeric_limits<double>::quiet_NaN());
        return solution;
    }

    std::string name() const override { return UMFPACK_VERSION; }

private:
    const SuiteSparse_long* columns() const { return matrix_.outerIndexPtr(); }
    const SuiteSparse_long* rows() const { return matrix_.innerIndexPtr(); }

    const SparseMatrix& matrix_;
    double control_[UMFPACK_CONTROL] = {};
    void *symbolic_ = nullptr, *numeric_ = nullptr;
};

}  // namespace

std::unique_ptr<PreparedSolver> prepare_umfpack(const SparseMatrix& matrix)
{
    return std::make_unique<UmfpackFactor>(matrix);
}

}  // namespace reference_fem

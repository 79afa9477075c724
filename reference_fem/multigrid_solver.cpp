// Conjugate gradients (Eigen), preconditioned by one V-cycle of smoothed aggregation (Trilinos ML through Epetra, on
// this process alone).

#include "pbs/geometry/cost.hpp"
#include "reference_fem/linear_solvers.hpp"
#include "reference_fem/options.hpp"

#include <Eigen/Geometry>
#include <Eigen/IterativeLinearSolvers>
#include <Epetra_CrsMatrix.h>
#include <Epetra_Map.h>
#include <Epetra_MpiComm.h>
#include <Epetra_Vector.h>
#include <Teuchos_ParameterList.hpp>
#include <ml_MultiLevelPreconditioner.h>
#include <mpi.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <set>
#include <string>

namespace reference_fem {

Eigen::MatrixXd rigid_body_modes(const pbs::Positions& nodes, const pbs::Vec3& centre, double length_m)
{
    Eigen::MatrixXd modes(3 * nodes.rows(), 6);
    for (Eigen::Index n = 0; n < nodes.rows(); ++n) {
        const pbs::Vec3 arm = (nodes.row(n).transpose() - centre) / length_m;
        modes.block<3, 3>(3 * n, 0).setIdentity();
        for (int axis = 0; axis < 3; ++axis) modes.block<3, 1>(3 * n, 3 + axis) = pbs::Vec3::Unit(axis).cross(arm);
    }
    return modes;
}

Eigen::MatrixXd rigid_body_modes(const pbs::Positions& nodes)
{
    const pbs::Vec3 low = nodes.colwise().minCoeff(), high = nodes.colwise().maxCoeff();
    return rigid_body_modes(nodes, (low + high) / 2.0, (high - low).norm());
}

Teuchos::ParameterList smoothed_aggregation(double* modes, int number_of_modes, int block_size)
{
    Teuchos::ParameterList parameters;
    ML_Epetra::SetDefaults("SA", parameters);
    parameters.set("ML output", 0);
    parameters.set("initialize random seed", true);  // the estimate of the largest eigenvalue repeats to the bit
    parameters.set("PDE equations", block_size);
    parameters.set("null space: type", "pre-computed");
    parameters.set("null space: dimension", number_of_modes);
    parameters.set("null space: vectors", modes);
    parameters.set("aggregation: type", "Uncoupled");  // no aggregate spans two ranks
    parameters.set("aggregation: threshold", 0.0);
    parameters.set("smoother: type", "Chebyshev");  // symmetric, and the same on any number of ranks
    parameters.set("smoother: sweeps", 2);
    parameters.set("smoother: Chebyshev alpha", 10.0);
    parameters.set("coarse: type", "Amesos-KLU");
    parameters.set("coarse: max size", 2000);
    return parameters;
}

namespace {

// In a process that mpirun did not start, MPI_Init of Open MPI sets environment variables that identify this rank.
// Child processes inherit them, and an mpirun among these children fails. The variables are therefore removed again.
void init_leaving_the_environment()
{
    const auto names = [] {
        std::set<std::string> names;
        for (char** variable = environ; *variable; ++variable) names.emplace(*variable, std::strcspn(*variable, "="));
        return names;
    };
    const std::set<std::string> before = names();
    MPI_Init(nullptr, nullptr);
    for (const std::string& name : names())
        if (!before.contains(name)) unsetenv(name.c_str());
}

// ML queries MPI for its rank even on one process. MPI is initialised with the first hierarchy and finalised with the
// program, unless the program did so itself.
void start_mpi()
{
    static const struct Mpi {
        Mpi()
        {
            int started = 0;
            MPI_Initialized(&started);
            ours = !started;
            if (ours) init_leaving_the_environment();
        }
        ~Mpi()
        {
            int ended = 0;
            MPI_Finalized(&ended);
            if (ours && !ended) MPI_Finalize();
        }
        bool ours = false;
    } mpi;
}

const Epetra_Comm& this_process()
{
    start_mpi();
    static const Epetra_MpiComm comm(MPI_COMM_SELF);
    return comm;
}

// A symmetric matrix's compressed columns are its compressed rows.
class Multigrid {
public:
    Multigrid(const SparseMatrix& matrix, const NearNullSpace& near_null_space)
        : modes_(near_null_space.modes.size() > 0 ? near_null_space.modes
                                                  : constants(matrix.rows(), near_null_space.block_size)),
          rows_(static_cast<int>(matrix.rows()), 0, this_process()),
          matrix_(Copy, rows_, rows_, entries_of_rows(matrix).data(), true)
    {
        std::vector<int> columns;
        for (int row = 0; row < matrix.rows(); ++row) {
            const auto first = matrix.outerIndexPtr()[row], end = matrix.outerIndexPtr()[row + 1];
            columns.assign(matrix.innerIndexPtr() + first, matrix.innerIndexPtr() + end);
            matrix_.InsertMyValues(row, static_cast<int>(end - first), matrix.valuePtr() + first, columns.data());
        }
        matrix_.FillComplete(rows_, rows_);
        const auto parameters =
            smoothed_aggregation(modes_.data(), static_cast<int>(modes_.cols()), near_null_space.block_size);
        hierarchy_ = std::make_unique<ML_Epetra::MultiLevelPreconditioner>(matrix_, parameters, true);
    }

    bool usable() const { return hierarchy_->IsPreconditionerComputed(); }

    void apply(const Eigen::VectorXd& residual, Eigen::VectorXd& correction) const
    {
        correction.resize(residual.size());
        const Epetra_Vector in(View, rows_, const_cast<double*>(residual.data()));
        Epetra_Vector out(View, rows_, correction.data());
        hierarchy_->ApplyInverse(in, out);
    }

private:
    static Eigen::MatrixXd constants(Eigen::Index rows, int block_size)
    {
        Eigen::MatrixXd modes = Eigen::MatrixXd::Zero(rows, block_size);
        for (Eigen::Index row = 0; row < rows; ++row) modes(row, row % block_size) = 1.0;
        return modes;
    }

    static std::vector<int> entries_of_rows(const SparseMatrix& matrix)
    {
        std::vector<int> entries(matrix.rows());
        for (std::size_t row = 0; row < entries.size(); ++row)
            entries[row] = static_cast<int>(matrix.outerIndexPtr()[row + 1] - matrix.outerIndexPtr()[row]);
        return entries;
    }

    Eigen::MatrixXd modes_;
    Epetra_Map rows_;
    Epetra_CrsMatrix matrix_;
    std::unique_ptr<ML_Epetra::MultiLevelPreconditioner> hierarchy_;
};

// The interface that Eigen requires of a preconditioner.
class MultigridPreconditioner {
public:
    void use(const Multigrid* multigrid) { multigrid_ = multigrid; }

    template <typename Matrix>
    MultigridPreconditioner& analyzePattern(const Matrix&)
    {
        return *this;
    }
    template <typename Matrix>
    MultigridPreconditioner& factorize(const Matrix&)
    {
        return *this;
    }
    template <typename Matrix>
    MultigridPreconditioner& compute(const Matrix&)
    {
        return *this;
    }
    Eigen::VectorXd solve(const Eigen::VectorXd& residual) const
    {
        Eigen::VectorXd correction;
        multigrid_->apply(residual, correction);
        return correction;
    }
    Eigen::ComputationInfo info() const { return Eigen::Success; }

private:
    const Multigrid* multigrid_ = nullptr;
};

class MultigridSolver : public PreparedSolver {
public:
    MultigridSolver(const SparseMatrix& matrix, const NearNullSpace& near_null_space)
        : matrix_(matrix), near_null_space_(near_null_space)
    {
        refactor();
    }

    void refactor() final
    {
        usable_ = matrix_.rows() == 0;
        if (usable_) return;
        const pbs::Stopwatch setup;
        multigrid_ = std::make_unique<Multigrid>(matrix_, near_null_space_);
        gradients_.preconditioner().use(multigrid_.get());
        gradients_.setTolerance(options_.tolerance);
        gradients_.setMaxIterations(options_.most_iterations);
        gradients_.compute(matrix_);
        factor_s_ = setup.seconds();
        usable_ = multigrid_->usable();
    }

    Eigen::VectorXd solve(const Eigen::VectorXd& right_hand_side) const override
    {
        Eigen::VectorXd solution = gradients_.solve(right_hand_side);
        const auto counted = gradients_.iterations();  // Eigen leaves out the one that converged
        iterations_ =
            right_hand_side.isZero(0.0) ? 0 : std::min(static_cast<int>(counted) + 1, options_.most_iterations);
        if (gradients_.info() != Eigen::Success) solution.setConstant(std::numeric_limits<double>::quiet_NaN());
        return solution;
    }

    std::string name() const override { return "conjugate gradients, Trilinos ML smoothed aggregation"; }
    int iterations() const override { return iterations_; }

private:
    const SparseMatrix& matrix_;
    NearNullSpace near_null_space_;
    IterativeOptions options_;
    std::unique_ptr<Multigrid> multigrid_;
    Eigen::ConjugateGradient<SparseMatrix, Eigen::Lower | Eigen::Upper, MultigridPreconditioner> gradients_;
    mutable int iterations_ = 0;
};

}  // namespace

std::unique_ptr<PreparedSolver> prepare_cg_ml(const SparseMatrix& matrix, const NearNullSpace& near_null_space)
{
    return std::make_unique<MultigridSolver>(matrix, near_null_space);
}

}  // namespace reference_fem

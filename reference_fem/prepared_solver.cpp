#include "reference_fem/prepared_solver.hpp"

#include "reference_fem/blas.hpp"

namespace reference_fem {

std::unique_ptr<PreparedSolver> prepare(const SparseMatrix& matrix, LinearSolver solver, const NearNullSpace& near_null_space)
{
    use_one_blas_thread();
    switch (solver) {
        case LinearSolver::umfpack:
            return prepare_umfpack(matrix);
        case LinearSolver::cg_ml:
            return prepare_cg_ml(matrix, near_null_space);
        case LinearSolver::cholmod:
            break;
    }
    return prepare_cholmod(matrix);
}

}  // namespace reference_fem

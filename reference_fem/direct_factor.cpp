#include "reference_fem/direct_factor.hpp"

#include "reference_fem/blas.hpp"

namespace reference_fem {

std::unique_ptr<DirectFactor> factorise(const SparseMatrix& matrix, LinearSolver solver)
{
    use_one_blas_thread();
    return solver == LinearSolver::cholmod ? factorise_with_cholmod(matrix) : factorise_with_umfpack(matrix);
}

}  // namespace reference_fem

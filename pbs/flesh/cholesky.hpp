// The Cholesky factor of a sparse symmetric positive definite matrix, computed once by CHOLMOD (Y. Chen, T. Davis, W. Hager, S.
// Rajamanickam, Algorithm 887, ACM TOMS 35(3), 2008) and kept. The factor goes into code of this library, which solves for x, y and z side
// by side.
#pragma once

#include <Eigen/SparseCore>

#include <vector>

namespace pbs {

// L L^T = P A P^T. L is stored by columns, the diagonal first, rows ascending.
struct CholeskyFactor {
    std::vector<int> order;       // row k of L belongs to row order[k] of A, #rows
    std::vector<int> first, row;  // first: #rows + 1
    std::vector<double> value;

    bool usable() const { return !first.empty(); }  // false: A is not positive definite in double
};

// lower: the lower triangle of A, compressed. CHOLMOD is in the module pbskin_cholmod; an InputError where that is missing.
CholeskyFactor cholesky_factor(const Eigen::SparseMatrix<double>& lower);

}  // namespace pbs

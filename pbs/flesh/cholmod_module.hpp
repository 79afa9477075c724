// The function of the module pbskin_cholmod: CHOLMOD brings BLAS, which is slow to load and which no other step needs.
#pragma once

#include "pbs/flesh/held_flesh.hpp"

// Fills in the factor, or leaves it empty if the matrix is not positive definite.
extern "C" void pbskin_cholmod_factor(const Eigen::SparseMatrix<double>& lower, pbs::CholeskyFactor& factor);

// The sparse solver of K u = f: two direct ones of SuiteSparse, and conjugate gradients with Trilinos ML for what does not fit.
#pragma once

namespace reference_fem {

// prepared_solver.hpp describes each of them; cholmod is the default everywhere.
enum class LinearSolver { cholmod, umfpack, cg_ml };

}  // namespace reference_fem

// The only sparse matrix format of the reference: compressed columns, 64-bit indices, as SuiteSparse's long interfaces read it in place.
// Stiffness matrices are symmetric and hold both triangles.
#pragma once

#include <Eigen/SparseCore>

#include <cstdint>

namespace reference_fem {

using SparseMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, std::int64_t>;  // compressed before a solver reads it

}  // namespace reference_fem

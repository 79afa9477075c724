// Solves L L^T x = b with a kept factor, for x, y and z side by side.
//   const TriangularSolve<float> solve(factor, place);
//   solve.apply(rows);   // b in, x out
// Columns of L with the same rows below (supernodes) are processed together, so that each row is read and written once for all of them.
#pragma once

#include "pbs/flesh/flesh_kernels.hpp"
#include "pbs/flesh/held_flesh.hpp"
#include "pbs/packed/rows.hpp"

namespace pbs {

template <typename Scalar>
class TriangularSolve {
public:
    // place: where row i of the matrix lies among the rows that are passed to apply, #rows.
    TriangularSolve(const CholeskyFactor& factor, const std::vector<int>& place);

    void apply(Scalar* rows);                         // four numbers per row
    std::size_t bytes() const;                        // of the factor, which an application reads twice
    std::size_t entries() const { return entries_; }  // of L

private:
    std::vector<Supernode> supernodes_;
    std::vector<std::uint32_t> below_;  // rows below the supernodes' triangles
    std::vector<Scalar> values_;
    std::vector<std::uint32_t> place_;  // of row k of L
    Rows<Scalar> work_;
    std::size_t entries_ = 0;
};

// The same with a loop per entry of L: the plain implementation, in double.
void solve_plainly(const CholeskyFactor& factor, const std::vector<int>& place, double* rows, std::vector<double>& work);

}  // namespace pbs

// A symmetric sparse matrix over the nodes of a space, of 3 x 3 blocks: block (i, j) exists where a tet has both nodes. It is stored as
// the plain compressed columns that SuiteSparse reads, so adding a block is nine additions in place.
#pragma once

#include "reference_fem/simplex_space.hpp"
#include "reference_fem/sparse_matrix.hpp"

#include <utility>
#include <vector>

namespace reference_fem {

// Degree of freedom 3 n + c is component c at node n.
class NodalMatrix {
public:
    explicit NodalMatrix(const SimplexSpace& space);  // zeros; the space may go

    void set_zero() { matrix_.coeffs().setZero(); }                               // the pattern stays
    void add_block(int row_node, int column_node, const Eigen::Matrix3d& block);  // of two nodes that share a tet
    // Blocks of one tet, k of them a side: values 3 k x 3 k.
    void add_tet(Eigen::Index tet, const Eigen::Ref<const Eigen::MatrixXd>& values);
    // factor times another NodalMatrix of this space, #dofs x #dofs.
    void add(const SparseMatrix& same_pattern, double factor);
    // factor times a matrix over the nodes, #nodes x #nodes with an entry where a tet has both: a multiple of the identity in each block.
    void add_isotropic(const SparseMatrix& of_nodes, double factor);

    const SparseMatrix& matrix() const& { return matrix_; }  // #dofs x #dofs, both triangles
    SparseMatrix matrix() && { return std::move(matrix_); }  // the same, moved out

private:
    SparseMatrix::StorageIndex place(int row_node, int column_node) const;  // of the block's first row in its columns
    template <typename Block>
    void add_at(SparseMatrix::StorageIndex place, int column_node, const Block& block);

    SparseMatrix matrix_;
    TetNodes tet_nodes_;
    std::vector<SparseMatrix::StorageIndex> tet_places_;  // per tet, row by row
};

}  // namespace reference_fem

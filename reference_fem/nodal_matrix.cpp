#include "reference_fem/nodal_matrix.hpp"

#include <algorithm>

namespace reference_fem {
namespace {

// Nodes that share a tet with each node, itself included, increasing.
std::vector<std::vector<int>> neighbours(const TetNodes& tet_nodes, int nodes)
{
    std::vector<std::vector<int>> adjacent(nodes);
    for (const auto& tet : tet_nodes.rowwise())
        for (const int node : tet) adjacent[node].insert(adjacent[node].end(), tet.begin(), tet.end());
    for (auto& of_node : adjacent) {
        std::sort(of_node.begin(), of_node.end());
        of_node.erase(std::unique(of_node.begin(), of_node.end()), of_node.end());
    }
    return adjacent;
}

}  // namespace

NodalMatrix::NodalMatrix(const SimplexSpace& space) : matrix_(space.dofs(), space.dofs()), tet_nodes_(space.tet_nodes())
{
    const auto adjacent = neighbours(tet_nodes_, space.nodes());
    std::size_t blocks = 0;
    for (const auto& of_node : adjacent) blocks += of_node.size();
    matrix_.reserve(9 * blocks);
    for (int column = 0; column < space.dofs(); ++column) {
        matrix_.startVec(column);
        for (const int row_node : adjacent[column / 3])
            for (int c = 0; c < 3; ++c) matrix_.insertBack(3 * row_node + c, column) = 0.0;
    }
    matrix_.finalize();

    tet_places_.reserve(tet_nodes_.size() * tet_nodes_.cols());
    for (const auto& tet : tet_nodes_.rowwise())
        for (const int row_node : tet)
            for (const int column_node : tet) tet_places_.push_back(place(row_node, column_node));
}

SparseMatrix::StorageIndex NodalMatrix::place(int row_node, int column_node) const
{
    const auto* begin = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[3 * column_node];
    const auto* end = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[3 * column_node + 1];
    return std::lower_bound(begin, end, 3 * row_node) - begin;
}

template <typename Block>
void NodalMatrix::add_at(SparseMatrix::StorageIndex place, int column_node, const Block& block)
{
    for (int c = 0; c < 3; ++c) {
        double* column = matrix_.valuePtr() + matrix_.outerIndexPtr()[3 * column_node + c] + place;
        for (int r = 0; r < 3; ++r) column[r] += block(r, c);
    }
}

void NodalMatrix::add_block(int row_node, int column_node, const Eigen::Matrix3d& block)
{
    add_at(place(row_node, column_node), column_node, block);
}

void NodalMatrix::add_tet(Eigen::Index tet, const Eigen::Ref<const Eigen::MatrixXd>& values)
{
    const Eigen::Index nodes = tet_nodes_.cols();
    const auto* places = tet_places_.data() + tet * nodes * nodes;
    for (Eigen::Index a = 0; a < nodes; ++a)
        for (Eigen::Index b = 0; b < nodes; ++b) add_at(places[a * nodes + b], tet_nodes_(tet, b), values.block<3, 3>(3 * a, 3 * b));
}

void NodalMatrix::add(const SparseMatrix& same_pattern, double factor)
{
    matrix_.coeffs() += factor * same_pattern.coeffs();
}

void NodalMatrix::add_isotropic(const SparseMatrix& of_nodes, double factor)
{
    for (Eigen::Index node = 0; node < of_nodes.cols(); ++node) {
        SparseMatrix::StorageIndex place = 0;
        for (SparseMatrix::InnerIterator entry(of_nodes, node); entry; ++entry, place += 3)
            for (int c = 0; c < 3; ++c) matrix_.valuePtr()[matrix_.outerIndexPtr()[3 * node + c] + place + c] += factor * entry.value();
    }
}

}  // namespace reference_fem

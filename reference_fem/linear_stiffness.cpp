#include "reference_fem/assembly.hpp"
#include "reference_fem/element_tables.hpp"
#include "reference_fem/nodal_matrix.hpp"

namespace reference_fem {
namespace {

constexpr int most_nodes = 10;
using TetMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3 * most_nodes, 3 * most_nodes>;
using Gradients = Eigen::Ref<const pbs::Positions>;  // of the shape functions at a quadrature point, nodes x 3

// Block (a, b): lambda g_a g_b^T + mu (g_b g_a^T + (g_a . g_b) I), times the weight.
void add_blocks(const Gradients& gradients, const Lame& material, double weight, TetMatrix& stiffness)
{
    for (Eigen::Index a = 0; a < gradients.rows(); ++a)
        for (Eigen::Index b = 0; b < gradients.rows(); ++b) {
            const Eigen::RowVector3d g_a = gradients.row(a), g_b = gradients.row(b);
            const Eigen::Matrix3d outer = weight * g_a.transpose() * g_b;
            auto block = stiffness.block<3, 3>(3 * a, 3 * b);
            block += material.lambda_pa * outer + material.mu_pa * outer.transpose();
            block.diagonal().array() += material.mu_pa * outer.trace();
        }
}

}  // namespace

SparseMatrix stiffness_matrix(const SimplexSpace& space, const Lame& material)
{
    // Products of gradients have degree 2 (order - 1); n points a direction integrate degree 2 n - 1.
    const ElementTables tables = element_tables(space, space.element_order());
    NodalMatrix stiffness(space);
    TetMatrix of_tet(3 * tables.nodes_per_tet, 3 * tables.nodes_per_tet);
    for (Eigen::Index tet = 0; tet < space.tet_nodes().rows(); ++tet) {
        of_tet.setZero();
        for (int q = 0; q < tables.points_per_tet; ++q) add_blocks(tables.gradients(tet, q), material, tables.weight(tet, q), of_tet);
        stiffness.add_tet(tet, of_tet);
    }
    return std::move(stiffness).matrix();
}

}  // namespace reference_fem

#include "reference_fem/boundary_value_problem.hpp"

#include "reference_fem/eliminated_system.hpp"

#include "pbs/geometry/topology.hpp"

#include <algorithm>
#include <set>

namespace reference_fem {
namespace {

// Corners of the boundary's triangles, and the nodes in the middle of their edges, #nodes.
std::vector<bool> boundary_nodes(const SimplexSpace& space)
{
    std::vector<bool> on_boundary(space.nodes(), false);
    std::set<std::pair<int, int>> boundary_edges;
    const pbs::Triangles triangles = pbs::boundary_of(space.tet_nodes().leftCols(4));
    for (const auto& triangle : triangles.rowwise())
        for (int k = 0; k < 3; ++k) {
            on_boundary[triangle(k)] = true;
            boundary_edges.insert(std::minmax(int(triangle(k)), int(triangle((k + 1) % 3))));
        }
    for (const auto& tet : space.tet_nodes().rowwise())
        for (Eigen::Index middle = 4; middle < tet.size(); ++middle) {
            const auto& [first, second] = SimplexSpace::edge_corners[middle - 4];
            if (boundary_edges.contains(std::minmax(int(tet(first)), int(tet(second))))) on_boundary[tet(middle)] = true;
        }
    return on_boundary;
}

}  // namespace

BoundaryValueSolution solve(const pbs::TetMesh& mesh, const ElasticMaterial& material, const BoundaryValueProblem& problem)
{
    const auto space = std::make_shared<const SimplexSpace>(mesh, problem.element_order);
    const SparseMatrix stiffness = stiffness_matrix(*space, lame_parameters(material.young_pa, material.poisson));
    std::vector<bool> held(space->dofs(), false);
    Eigen::VectorXd prescribed = Eigen::VectorXd::Zero(space->dofs());
    const std::vector<bool> on_boundary = boundary_nodes(*space);
    for (int node = 0; node < space->nodes(); ++node) {
        const pbs::Vec3 point = space->node_positions().row(node);
        if (!on_boundary[node] || (problem.held && !problem.held(point))) continue;
        prescribed.segment<3>(3 * node) = problem.displacement(point);
        for (int c = 0; c < 3; ++c) held[3 * node + c] = true;
    }
    const Eigen::VectorXd load = problem.body_force ? load_vector(*space, problem.body_force) : Eigen::VectorXd::Zero(space->dofs()).eval();
    const EliminatedSystem system(stiffness, held, problem.solver);
    const EliminatedSolution solution = system.solve(load, prescribed);
    return {space, solution.displacement, solution.residual};
}

ErrorNorms BoundaryValueSolution::errors(const VectorField& exact, const GradientField& exact_gradient) const
{
    return error_norms(*space, displacement, exact, exact_gradient);
}

double BoundaryValueSolution::largest_nodal_error(const VectorField& exact) const
{
    double largest = 0.0;
    for (int node = 0; node < space->nodes(); ++node)
        largest = std::max(largest, (displacement.segment<3>(3 * node) - exact(space->node_positions().row(node))).norm());
    return largest;
}

double BoundaryValueSolution::strain_energy_j(const ElasticMaterial& material) const
{
    return strain_energy(*space, lame_parameters(material.young_pa, material.poisson), displacement);
}

}  // namespace reference_fem

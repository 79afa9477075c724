#include "reference_fem/boundary_value_problem.hpp"

#include "pbs/geometry/topology.hpp"
#include "reference_fem/linear_flesh.hpp"
#include "reference_fem/potentials/potentials.hpp"

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
            if (boundary_edges.contains(std::minmax(int(tet(first)), int(tet(second)))))
                on_boundary[tet(middle)] = true;
        }
    return on_boundary;
}

int nearest(const Eigen::Ref<const pbs::Positions>& points, const pbs::Vec3& point)
{
    Eigen::Index index = 0;
    (points.rowwise() - point.transpose()).rowwise().squaredNorm().minCoeff(&index);
    return static_cast<int>(index);
}

}  // namespace

PrescribedData prescribed_data(const SimplexSpace& space, const BoundaryValueProblem& problem)
{
    PrescribedData data{std::vector<bool>(space.dofs(), false), Eigen::VectorXd::Zero(space.dofs())};
    const std::vector<bool> on_boundary = boundary_nodes(space);
    for (int node = 0; node < space.nodes(); ++node) {
        if (!on_boundary[node]) continue;
        const pbs::Vec3 point = space.node_positions().row(node);
        const Held held = problem.held ? problem.held(point) : Held(true);
        const bool components[3] = {held.x, held.y, held.z};
        for (int c = 0; c < 3; ++c) data.held[3 * node + c] = components[c];
        if (problem.displacement && (held.x || held.y || held.z))
            data.values.segment<3>(3 * node) = problem.displacement(point);
    }
    return data;
}

Eigen::VectorXd external_load(const SimplexSpace& space, const BoundaryValueProblem& problem)
{
    Eigen::VectorXd load = Eigen::VectorXd::Zero(space.dofs());
    if (problem.body_force) load += load_vector(space, problem.body_force);
    for (const Traction& traction : problem.tractions) load += traction_load(space, traction);
    return load;
}

int nearest_node(const SimplexSpace& space, const pbs::Vec3& point)
{
    return nearest(space.node_positions(), point);
}

BoundaryValueSolution solve(const pbs::TetMesh& mesh, const ElasticMaterial& material,
                            const BoundaryValueProblem& problem)
{
    const auto space = std::make_shared<const SimplexSpace>(mesh, problem.element_order);
    const LinearFlesh flesh(*space, lame_parameters(material.young_pa, material.poisson), problem.formulation);
    const SparseMatrix stiffness = flesh.stiffness();
    const PrescribedData prescribed = prescribed_data(*space, problem);
    const Eigen::VectorXd load = external_load(*space, problem);
    const EliminatedSystem system(stiffness, flesh.prescribed(prescribed.held), flesh.solver(problem.solver));
    const EliminatedSolution solution = system.solve(flesh.on_unknowns(load), flesh.on_unknowns(prescribed.values));
    return {space,
            flesh.displacement(solution.displacement),
            solution.residual,
            load,
            prescribed.held,
            problem.formulation,
            flesh.pressure_pa(solution.displacement)};
}

ErrorNorms BoundaryValueSolution::errors(const VectorField& exact, const GradientField& exact_gradient) const
{
    return error_norms(*space, displacement, exact, exact_gradient);
}

double BoundaryValueSolution::largest_nodal_error(const VectorField& exact) const
{
    double largest = 0.0;
    for (int node = 0; node < space->nodes(); ++node)
        largest =
            std::max(largest, (displacement.segment<3>(3 * node) - exact(space->node_positions().row(node))).norm());
    return largest;
}

double BoundaryValueSolution::strain_energy_j(const ElasticMaterial& material) const
{
    const LinearFlesh flesh(*space, lame_parameters(material.young_pa, material.poisson), formulation);
    return flesh.strain_energy_j(displacement, pressure_pa);
}

pbs::Vec3 BoundaryValueSolution::displacement_at(const pbs::Vec3& point) const
{
    return displacement.segment<3>(3 * nearest_node(*space, point));
}

Eigen::Matrix3d BoundaryValueSolution::stress_at(const pbs::Vec3& point, const ElasticMaterial& material) const
{
    const int vertices = space->tet_nodes().leftCols(4).maxCoeff() + 1;
    const int vertex = nearest(space->node_positions().topRows(vertices), point);
    const Eigen::Matrix3d gradient = gradient_at_vertex(*space, displacement, vertex);
    const Eigen::Matrix3d strain = (gradient + gradient.transpose()) / 2.0;
    const Lame lame = lame_parameters(material.young_pa, material.poisson);
    const double pressure =
        LinearFlesh(*space, lame, formulation).pressure_at_vertex_pa(displacement, pressure_pa, vertex);
    return pressure * Eigen::Matrix3d::Identity() + 2.0 * lame.mu_pa * strain;
}

FiniteStrainSolution solve_at_finite_strain(const pbs::TetMesh& mesh, const ElasticMaterial& material, Model model,
                                            const BoundaryValueProblem& problem, const LoadPathOptions& path)
{
    FiniteStrainSolution solution{std::make_shared<const SimplexSpace>(mesh, problem.element_order), {}, {}};
    const SimplexSpace& space = *solution.space;
    solution.displacement.setZero(space.dofs());
    const ElasticPotential flesh(space, model, lame_parameters(material.young_pa, material.poisson),
                                 problem.formulation);
    const PrescribedData prescribed = prescribed_data(space, problem);
    const Eigen::VectorXd whole_load = external_load(space, problem);
    DeadLoad load(Eigen::VectorXd::Zero(space.dofs()));
    NewtonMinimiser newton(space, prescribed.held, problem.solver);
    solution.path = follow_load_path(
        [&](double fraction) {
            load.set(fraction * whole_load);
            return newton.minimise({&flesh, &load}, fraction * prescribed.values, solution.displacement, {});
        },
        solution.displacement, path);
    return solution;
}

pbs::Vec3 FiniteStrainSolution::displacement_at(const pbs::Vec3& point) const
{
    return displacement.segment<3>(3 * nearest_node(*space, point));
}

}  // namespace reference_fem

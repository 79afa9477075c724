#include "reference_fem/verification/calculix/nodal_problem.hpp"

#include "reference_fem/eliminated_system.hpp"

namespace reference_fem {

Eigen::Map<const Eigen::VectorXd> as_dofs(const pbs::Positions& at_nodes)
{
    return {at_nodes.data(), at_nodes.size()};
}

pbs::Positions at_nodes(const Eigen::VectorXd& dofs)
{
    return Eigen::Map<const pbs::Positions>(dofs.data(), dofs.size() / 3, 3);
}

NodalProblem nodal_problem(const SimplexSpace& space, const ElasticMaterial& material)
{
    NodalProblem problem;
    problem.nodes = space.node_positions();
    problem.tets = space.tet_nodes();
    problem.material = material;
    problem.held.assign(space.nodes(), false);
    problem.held_at = problem.forces_n = pbs::Positions::Zero(space.nodes(), 3);
    return problem;
}

pbs::Positions linear_displacements(const SimplexSpace& space, const NodalProblem& problem)
{
    const auto lame = lame_parameters(problem.material.young_pa, problem.material.poisson);
    const pbs::Vec3 body_force = problem.density_kg_m3 * problem.gravity_m_s2;
    const Eigen::VectorXd load = load_vector(space, [&](const pbs::Vec3&) { return body_force; }) + as_dofs(problem.forces_n);
    std::vector<bool> prescribed(space.dofs());
    for (int dof = 0; dof < space.dofs(); ++dof) prescribed[dof] = problem.held[dof / 3];
    const EliminatedSystem system(stiffness_matrix(space, lame), prescribed, LinearSolver::cholmod);
    return at_nodes(system.solve(load, as_dofs(problem.held_at)).displacement);
}

}  // namespace reference_fem

#include "experiments/studies/verification/calculix/second_opinion_cases.hpp"

#include "reference_fem/elastic_body.hpp"
#include "reference_fem/linear_elasticity.hpp"

#include <cmath>

namespace experiments {
namespace {

const reference_fem::NewtonOptions newton_options{.relative_tolerance = 1e-11};

std::vector<int> nodes_at(const pbs::Positions& nodes, double x, double tolerance)
{
    std::vector<int> at;
    for (Eigen::Index n = 0; n < nodes.rows(); ++n)
        if (std::abs(nodes(n, 0) - x) <= tolerance) at.push_back(static_cast<int>(n));
    return at;
}

// Every node of a prescribed tet is at its bone's target; mid-edge nodes halfway between their ends.
NodalProblem posed_problem(const reference_fem::SimplexSpace& space, const HeldFrame& frame, const BoneAttachment& bones)
{
    NodalProblem problem = nodal_problem(space, frame.material);
    for (const int tet : bones.attachment.prescribed_tets)
        for (const int node : space.tet_nodes().row(tet)) problem.held[node] = true;
    const pbs::Positions rest = space.node_positions().topRows(bones.vertex_bone.size());
    problem.held_at = space.from_vertices(vertex_targets(bones, rest, frame.pose_at(1.0)) - rest);
    return problem;
}

void answer_by_linear_elasticity(const pbs::TetMesh& mesh, int element_order, const HeldFrame& frame, const BoneAttachment& bones,
                                 AnsweredProblem& answer)
{
    const reference_fem::LinearOptions options{
        .element_order = element_order, .young_pa = frame.material.young_pa, .poisson = frame.material.poisson};
    reference_fem::LinearElasticity elasticity(mesh, options, bones.attachment);
    answer.answered = elasticity.solve({0, 3}, vertex_targets(bones, mesh.rest, frame.pose_at(1.0))).finite;
    answer.displacements = at_nodes(elasticity.displacement());
}

void answer_by_elastic_body(const pbs::TetMesh& mesh, int element_order, const HeldFrame& frame, const BoneAttachment& bones,
                            AnsweredProblem& answer)
{
    reference_fem::ElasticOptions options;
    options.model = reference_fem::Model::st_venant_kirchhoff;
    options.element_order = element_order;
    options.young_pa = frame.material.young_pa;
    options.poisson = frame.material.poisson;
    options.newton = newton_options;
    reference_fem::ElasticBody body(mesh, options, bones.attachment);
    const auto targets_at = [&](double fraction) {
        return reference_fem::Targets{{0, 3}, vertex_targets(bones, mesh.rest, frame.pose_at(fraction)), {}};
    };
    answer.answered = body.solve(targets_at, pbs::Vec3::Zero()).converged();
    answer.displacements = at_nodes(body.displacement());
}

// The four points of C3D10, exact to degree 2: A. Stroud, Approximate Calculation of Multiple Integrals, 1971, T3: 2-1.
reference_fem::TetQuadrature four_points()
{
    const double near = (5.0 + 3.0 * std::sqrt(5.0)) / 20.0, far = (5.0 - std::sqrt(5.0)) / 20.0;
    reference_fem::TetQuadrature quadrature{pbs::Positions::Constant(4, 3, far), Eigen::VectorXd::Constant(4, 1.0 / 24.0)};
    for (int point = 1; point < 4; ++point) quadrature.points(point, point - 1) = near;
    return quadrature;
}

void answer_by_four_points(const pbs::TetMesh& mesh, int element_order, const HeldFrame& frame, const BoneAttachment& bones,
                           AnsweredProblem& answer)
{
    const reference_fem::SimplexSpace space(mesh, element_order);
    const reference_fem::ElasticPotential flesh(
        space, reference_fem::Model::st_venant_kirchhoff, reference_fem::lame_parameters(frame.material.young_pa, frame.material.poisson),
        reference_fem::Formulation::displacement, reference_fem::element_tables(space, four_points()));
    std::vector<bool> prescribed(space.dofs());
    for (int dof = 0; dof < space.dofs(); ++dof) prescribed[dof] = answer.problem.held[dof / 3];
    reference_fem::NewtonMinimiser newton(space, prescribed, reference_fem::LinearSolver::cholmod);
    Eigen::VectorXd displacement = Eigen::VectorXd::Zero(space.dofs());
    const auto attempt = [&](double fraction) {
        const pbs::Positions held_at = space.from_vertices(vertex_targets(bones, mesh.rest, frame.pose_at(fraction)) - mesh.rest);
        return newton.minimise({&flesh}, as_dofs(held_at), displacement, newton_options);
    };
    answer.answered = reference_fem::follow_load_path(attempt, displacement, {}).converged();
    answer.displacements = at_nodes(displacement);
}

}  // namespace

NodalProblem cantilever_problem(const reference_fem::SimplexSpace& space, const LoadedCantilever& cantilever)
{
    NodalProblem problem = nodal_problem(space, cantilever.material);
    problem.density_kg_m3 = cantilever.density_kg_m3;
    problem.gravity_m_s2 = cantilever.gravity_m_s2;
    const double root = problem.nodes.col(0).minCoeff(), end = problem.nodes.col(0).maxCoeff();
    const double tolerance = 1e-9 * (end - root);
    for (const int node : nodes_at(problem.nodes, root, tolerance)) problem.held[node] = true;
    const std::vector<int> loaded = nodes_at(problem.nodes, end, tolerance);
    for (const int node : loaded) problem.forces_n.row(node) = cantilever.end_load_n.transpose() / static_cast<double>(loaded.size());
    return problem;
}

AnsweredProblem answered_cantilever(const pbs::TetMesh& mesh, int element_order, const LoadedCantilever& cantilever)
{
    const reference_fem::SimplexSpace space(mesh, element_order);
    AnsweredProblem answer{cantilever_problem(space, cantilever), {}};
    answer.displacements = linear_displacements(space, answer.problem);
    answer.answered = answer.displacements.allFinite();
    return answer;
}

AnsweredProblem answered_frame(const pbs::Character& character, int element_order, const HeldFrame& frame)
{
    const BoneAttachment bones = nodes_attachment(character, {.attachment = FemAttachment::nodes, .core_radius = frame.core_radius});
    AnsweredProblem answer{posed_problem(reference_fem::SimplexSpace(character.mesh, element_order), frame, bones), {}};
    const auto answer_by = frame.model == FrameModel::linear                ? answer_by_linear_elasticity
                           : frame.model == FrameModel::st_venant_kirchhoff ? answer_by_elastic_body
                                                                            : answer_by_four_points;
    answer_by(character.mesh, element_order, frame, bones, answer);
    return answer;
}

}  // namespace experiments

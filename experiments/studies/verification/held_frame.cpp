#include "experiments/studies/verification/held_frame.hpp"

#include "reference_fem/elastic_body.hpp"
#include "reference_fem/linear_elasticity.hpp"

#include <cmath>

namespace experiments {

using namespace reference_fem;

namespace {

const NewtonOptions newton_options{.relative_tolerance = 1e-11};

// Every node of a prescribed tet is at its bone's target. Mid-edge nodes are halfway between their ends.
NodalProblem posed_problem(const SimplexSpace& space, const HeldFrame& frame, const BoneAttachment& bones)
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
    const LinearOptions options{.element_order = element_order, .young_pa = frame.material.young_pa, .poisson = frame.material.poisson};
    LinearElasticity elasticity(mesh, options, bones.attachment);
    answer.answered = elasticity.solve({0, 3}, vertex_targets(bones, mesh.rest, frame.pose_at(1.0))).finite;
    answer.displacements = at_nodes(elasticity.displacement());
}

void answer_by_elastic_body(const pbs::TetMesh& mesh, int element_order, const HeldFrame& frame, const BoneAttachment& bones,
                            AnsweredProblem& answer)
{
    ElasticOptions options;
    options.model = Model::st_venant_kirchhoff;
    options.element_order = element_order;
    options.young_pa = frame.material.young_pa;
    options.poisson = frame.material.poisson;
    options.newton = newton_options;
    ElasticBody body(mesh, options, bones.attachment);
    const auto targets_at = [&](double fraction) { return Targets{{0, 3}, vertex_targets(bones, mesh.rest, frame.pose_at(fraction)), {}}; };
    answer.answered = body.solve(targets_at, pbs::Vec3::Zero()).converged();
    answer.displacements = at_nodes(body.displacement());
}

// The four points of C3D10, exact to degree 2: A. Stroud, Approximate Calculation of Multiple Integrals, 1971, T3: 2-1.
TetQuadrature four_points()
{
    const double near = (5.0 + 3.0 * std::sqrt(5.0)) / 20.0, far = (5.0 - std::sqrt(5.0)) / 20.0;
    TetQuadrature quadrature{pbs::Positions::Constant(4, 3, far), Eigen::VectorXd::Constant(4, 1.0 / 24.0)};
    for (int point = 1; point < 4; ++point) quadrature.points(point, point - 1) = near;
    return quadrature;
}

void answer_by_four_points(const pbs::TetMesh& mesh, int element_order, const HeldFrame& frame, const BoneAttachment& bones,
                           AnsweredProblem& answer)
{
    const SimplexSpace space(mesh, element_order);
    const ElasticPotential flesh(space, Model::st_venant_kirchhoff, lame_parameters(frame.material.young_pa, frame.material.poisson),
                                 Formulation::displacement, element_tables(space, four_points()));
    std::vector<bool> prescribed(space.dofs());
    for (int dof = 0; dof < space.dofs(); ++dof) prescribed[dof] = answer.problem.held[dof / 3];
    NewtonMinimiser newton(space, prescribed, LinearSolver::cholmod);
    Eigen::VectorXd displacement = Eigen::VectorXd::Zero(space.dofs());
    const auto attempt = [&](double fraction) {
        const pbs::Positions held_at = space.from_vertices(vertex_targets(bones, mesh.rest, frame.pose_at(fraction)) - mesh.rest);
        return newton.minimise({&flesh}, as_dofs(held_at), displacement, newton_options);
    };
    answer.answered = follow_load_path(attempt, displacement, {}).converged();
    answer.displacements = at_nodes(displacement);
}

}  // namespace

AnsweredProblem answered_frame(const pbs::Character& character, int element_order, const HeldFrame& frame)
{
    const BoneAttachment bones = nodes_attachment(character, {.attachment = FemAttachment::nodes, .core_radius = frame.core_radius});
    AnsweredProblem answer{posed_problem(SimplexSpace(character.mesh, element_order), frame, bones), {}};
    const auto answer_by = frame.model == FrameModel::linear                ? answer_by_linear_elasticity
                           : frame.model == FrameModel::st_venant_kirchhoff ? answer_by_elastic_body
                                                                            : answer_by_four_points;
    answer_by(character.mesh, element_order, frame, bones, answer);
    return answer;
}

}  // namespace experiments

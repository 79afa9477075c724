#include "reference_fem/verification/calculix/held_body.hpp"

#include "reference_fem/linear_elasticity.hpp"
#include "reference_fem/potentials/spring_potential.hpp"
#include "reference_fem/verification/rounding_bound.hpp"

#include <cmath>

namespace reference_fem {
namespace {

const NewtonOptions newton_options{.relative_tolerance = 1e-11};

// Every node of a prescribed tet is at its target. Mid-edge nodes are halfway between their ends.
NodalProblem held_problem(const SimplexSpace& space, const pbs::Positions& rest, const HeldBody& body)
{
    NodalProblem problem = nodal_problem(space, body.material);
    for (const int tet : body.attachment.prescribed_tets)
        for (const int node : space.tet_nodes().row(tet)) problem.held[node] = true;
    const Targets targets = body.targets_at(1.0);
    problem.held_at = space.from_vertices(targets.vertices - rest);
    problem.springs = {body.attachment.spring_points, targets.springs, body.attachment.spring_stiffness};
    return problem;
}

void answer_by_linear_elasticity(const pbs::TetMesh& mesh, const HeldBody& body, AnsweredProblem& answer)
{
    const LinearOptions options{.element_order = body.element_order, .young_pa = body.material.young_pa, .poisson = body.material.poisson};
    LinearElasticity elasticity(mesh, options, body.attachment);
    const Targets targets = body.targets_at(1.0);
    answer.answered = elasticity.solve(targets.springs, targets.vertices).finite;
    answer.displacements = at_nodes(elasticity.displacement());
}

void answer_by_elastic_body(const pbs::TetMesh& mesh, const HeldBody& body, AnsweredProblem& answer)
{
    ElasticOptions options;
    options.model = Model::st_venant_kirchhoff;
    options.element_order = body.element_order;
    options.young_pa = body.material.young_pa;
    options.poisson = body.material.poisson;
    options.newton = newton_options;
    ElasticBody elastic(mesh, options, body.attachment);
    answer.answered = elastic.solve(body.targets_at, pbs::Vec3::Zero()).converged();
    answer.displacements = at_nodes(elastic.displacement());
}

// The four points of C3D10, exact to degree 2: A. Stroud, Approximate Calculation of Multiple Integrals, 1971, T3: 2-1.
TetQuadrature four_points()
{
    const double near = (5.0 + 3.0 * std::sqrt(5.0)) / 20.0, far = (5.0 - std::sqrt(5.0)) / 20.0;
    TetQuadrature quadrature{pbs::Positions::Constant(4, 3, far), Eigen::VectorXd::Constant(4, 1.0 / 24.0)};
    for (int point = 1; point < 4; ++point) quadrature.points(point, point - 1) = near;
    return quadrature;
}

std::vector<bool> held_dofs(const NodalProblem& problem)
{
    std::vector<bool> held(3 * problem.held.size());
    for (std::size_t dof = 0; dof < held.size(); ++dof) held[dof] = problem.held[dof / 3];
    return held;
}

void answer_by_four_points(const pbs::TetMesh& mesh, const HeldBody& body, AnsweredProblem& answer)
{
    const SimplexSpace space(mesh, body.element_order);
    const ElasticPotential flesh(space, Model::st_venant_kirchhoff, lame_parameters(body.material.young_pa, body.material.poisson),
                                 Formulation::displacement, element_tables(space, four_points()));
    const AttachedPoints points(mesh, space, body.attachment.spring_points, body.attachment.spring_stiffness);
    SpringPotential springs(points);
    NewtonMinimiser newton(space, held_dofs(answer.problem), LinearSolver::cholmod);
    Eigen::VectorXd displacement = Eigen::VectorXd::Zero(space.dofs());
    const auto attempt = [&](double fraction) {
        const Targets targets = body.targets_at(fraction);
        springs.move_to(targets.springs);
        const pbs::Positions held_at = space.from_vertices(targets.vertices - mesh.rest);
        return newton.minimise({&flesh, &springs}, as_dofs(held_at), displacement, newton_options);
    };
    answer.answered = follow_load_path(attempt, displacement, {}).converged();
    answer.displacements = at_nodes(displacement);
}

}  // namespace

AnsweredProblem answered_body(const pbs::TetMesh& mesh, const HeldBody& body)
{
    AnsweredProblem answer{held_problem(SimplexSpace(mesh, body.element_order), mesh.rest, body), {}};
    const auto answer_by = body.model == BodyModel::linear                ? answer_by_linear_elasticity
                           : body.model == BodyModel::st_venant_kirchhoff ? answer_by_elastic_body
                                                                          : answer_by_four_points;
    answer_by(mesh, body, answer);
    return answer;
}

DeckOptions deck_options(const HeldBody& body)
{
    DeckOptions options;
    options.analysis = body.model == BodyModel::linear ? CalculixAnalysis::linear : CalculixAnalysis::large_strain;
    if (body.attachment.spring_points.rows() > 0) options.residual = 1e-12;
    return options;
}

double difference_bound(const pbs::TetMesh& mesh, const HeldBody& body, const pbs::Positions& displacements)
{
    const SimplexSpace space(mesh, body.element_order);
    SparseMatrix stiffness = stiffness_matrix(space, lame_parameters(body.material.young_pa, body.material.poisson));
    AttachedPoints(mesh, space, body.attachment.spring_points, body.attachment.spring_stiffness).add_to(stiffness);
    const Spectrum at_rest = spectrum(stiffness, held_dofs(held_problem(space, mesh.rest, body)));
    double bound = rounding_bound(at_rest);
    if (body.model != BodyModel::linear)
        bound +=
            (2.0 * newton_options.relative_tolerance + std::sqrt(at_rest.unknowns) * deck_options(body).residual) * at_rest.condition();
    return bound * displacements.norm() / displacements.rowwise().norm().maxCoeff();
}

std::string difference_bound_text(BodyModel model)
{
    const std::string of_both = "by eigenvalues of this very matrix, times |u| over the largest displacement";
    if (model == BodyModel::linear) return "rounding of a direct solve: sqrt(n) eps cond(K), cond(K) " + of_both;
    return "rounding and both Newton methods' last residuals: (sqrt(n) (eps + 1e-12) + 2e-11) cond(K), cond(K) at rest " + of_both;
}

}  // namespace reference_fem

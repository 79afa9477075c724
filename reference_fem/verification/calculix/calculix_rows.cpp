#include "reference_fem/verification/calculix/calculix_rows.hpp"

#include "reference_fem/linear_elasticity.hpp"
#include "reference_fem/linear_flesh.hpp"
#include "reference_fem/linear_solvers.hpp"
#include "reference_fem/potentials/potentials.hpp"

#include <ctime>

namespace reference_fem {
namespace {

std::vector<int> nodes_at(const pbs::Positions& nodes, double x, double tolerance)
{
    std::vector<int> at;
    for (Eigen::Index n = 0; n < nodes.rows(); ++n)
        if (std::abs(nodes(n, 0) - x) <= tolerance) at.push_back(static_cast<int>(n));
    return at;
}

double cpu_s()
{
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

double calculix_cpu_s(const std::string& program, const NodalProblem& problem, CalculixAnalysis analysis)
{
    const DeckOptions options{.analysis = analysis, .restart_file = false};
    const CalculixRun run = run_calculix(program, [&](std::ostream& deck) { write_calculix_deck(deck, problem, options); }, {});
    if (run.outcome != CalculixOutcome::finished)
        throw std::runtime_error(program + ": " + name_of(run.outcome) + ": " + last_words(run.output));
    return run.cpu_s;
}

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

// The condition number of the cantilever on the finest mesh, from its first bending mode (12.4 E I / L^3 over a third of its 16,393 nodes)
// against the stiffness of one edge (5 E h), is 2e7; sqrt(n) eps cond(K) = 5e-7. CalculiX stops Newton at 1e-9 of the mean force.
constexpr double largest_difference = 1e-6;
const std::string largest_difference_from =
    "rounding of a direct solve: sqrt(n) eps cond(K), cond(K) = 2e7 from the slowest mode of the longest cantilever";
const Divisions divisions = {48, 6, 6};

pbs::TetMesh cantilever_mesh()
{
    return box_mesh({0, 0, 0}, {10, 1, 1}, divisions);
}

LoadedCantilever cantilever_of(const Effort& effort)
{
    return {solver_material(effort, calculix_flesh), 1000.0, {0.0, 1e-3, -1e-2}, {0.3, 0.0, -0.5}};
}

}  // namespace

NodalProblem cantilever_problem(const SimplexSpace& space, const LoadedCantilever& cantilever)
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
    const SimplexSpace space(mesh, element_order);
    AnsweredProblem answer{cantilever_problem(space, cantilever), {}};
    answer.displacements = linear_displacements(space, answer.problem);
    answer.answered = answer.displacements.allFinite();
    return answer;
}

FirstSolveTiming time_first_solve(const std::string& program, const pbs::TetMesh& mesh, int element_order,
                                  const LoadedCantilever& cantilever, int repeats)
{
    use_one_blas_thread();
    FirstSolveTiming timing;
    const auto keep_smallest = [](double& kept, double seconds) { kept = kept > 0.0 ? std::min(kept, seconds) : seconds; };
    for (int repeat = 0; repeat < repeats; ++repeat) {
        const double start = cpu_s();
        const SimplexSpace space(mesh, element_order);
        keep_smallest(timing.elements_s, cpu_s() - start);
        const NodalProblem problem = cantilever_problem(space, cantilever);
        const double solve_start = cpu_s();
        linear_displacements(space, problem);
        keep_smallest(timing.solve_s, cpu_s() - solve_start);
        keep_smallest(timing.calculix_s, calculix_cpu_s(program, problem, CalculixAnalysis::linear));
        keep_smallest(timing.reading_s, calculix_cpu_s(program, problem, CalculixAnalysis::none));
        timing.dofs = space.dofs();
    }
    return timing;
}

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

VerificationRow calculix_row(const CalculixComparison& comparison, const std::string& pose, const std::string& law, AnsweredProblem answer,
                             const DeckOptions& options)
{
    const int element_order = answer.problem.tets.cols() == 4 ? 1 : 2;
    answer.problem.material = calculix_flesh;  // CalculiX has the right material, whatever error the effort asks of the reference
    const SecondOpinion opinion = second_opinion(comparison.program, answer, options);
    VerificationRow row =
        row_about({"calculix", elements_of(element_order), material_of(law, calculix_flesh.poisson), "", 0.0,
                   3 * static_cast<int>(answer.problem.nodes.rows())},
                  {"largest_node_difference", "largest node difference over largest displacement, " + pose, identifier_of(pose)},
                  answer.answered ? opinion.relative_difference() : not_reached, 0.0, "1",
                  comparison.version + ", " + (element_order == 1 ? "C3D4" : "C3D10"));
    bound(row, {}, largest_difference, largest_difference_from);
    if (opinion.outcome != CalculixOutcome::finished) {
        row.value = not_reached;
        row.note = std::string("CalculiX has no answer (") + name_of(opinion.outcome) + "): " + opinion.last_words;
    } else if (!opinion.in_double)
        row.note = "CalculiX's displacements to 7 digits only";
    return row;
}

VerificationRows calculix_cantilever_rows(const CalculixComparison& comparison)
{
    VerificationRows rows;
    for (const int element_order : {1, 2}) {
        const AnsweredProblem answer = answered_cantilever(cantilever_mesh(), element_order, cantilever_of(comparison.effort));
        rows.push_back(calculix_row(comparison, "cantilever", "linear", answer, {}));
        rows.back().mesh = text_of(divisions);
        rows.back().h_m = 1.0 / divisions[1];
    }
    return rows;
}

VerificationRows calculix_timing_rows(const CalculixComparison& comparison)
{
    const FirstSolveTiming timing = time_first_solve(comparison.program, cantilever_mesh(), 1, cantilever_of(comparison.effort), 9);
    const auto row = [&](const RowQuantity& quantity, double value, const std::string& note) {
        VerificationRow timed = row_about(
            {"calculix", elements_of(1), linear_material(calculix_flesh.poisson), text_of(divisions), 1.0 / divisions[1], timing.dofs},
            quantity, value, 3.0, "1", comparison.version + ", one thread, SPOOLES; processor time, the smallest of nine");
        timed.note = note;
        return timed;
    };
    const auto ms = [](double seconds) { return std::to_string(static_cast<int>(std::lround(1e3 * seconds))) + " ms"; };
    return {row({"time_ratio", "time of CalculiX over ours, first solve"}, timing.speedup(),
                "wanted, and not judged, for machines are noisy: at least 3 times; ours, stiffness, load, analysis, factor and solve: " +
                    ms(timing.solve_s) + "; CalculiX, the whole process: " + ms(timing.calculix_s)),
            row({"time_ratio_with_elements", "the same with our set-up of the elements"}, timing.speedup_with_elements(),
                "triangulation and numbering: " + ms(timing.elements_s)),
            row({"time_ratio_without_reading", "the same without CalculiX's start and reading of the mesh"},
                timing.speedup_without_reading(), "start and reading: " + ms(timing.reading_s))};
}

}  // namespace reference_fem

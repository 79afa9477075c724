#include "reference_fem/verification/calculix/loaded_cantilever.hpp"

#include "reference_fem/blas.hpp"
#include "reference_fem/verification/calculix/calculix_deck.hpp"
#include "reference_fem/verification/calculix/calculix_run.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <stdexcept>

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

}  // namespace reference_fem

#include "experiments/studies/verification/calculix/first_solve_timing.hpp"

#include "experiments/studies/verification/calculix/calculix_deck.hpp"
#include "experiments/studies/verification/calculix/calculix_run.hpp"
#include "reference_fem/blas.hpp"

#include <algorithm>
#include <ctime>
#include <stdexcept>

namespace experiments {
namespace {

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

FirstSolveTiming time_first_solve(const std::string& program, const pbs::TetMesh& mesh, int element_order,
                                  const LoadedCantilever& cantilever, int repeats)
{
    reference_fem::use_one_blas_thread();
    FirstSolveTiming timing;
    const auto keep_smallest = [](double& kept, double seconds) { kept = kept > 0.0 ? std::min(kept, seconds) : seconds; };
    for (int repeat = 0; repeat < repeats; ++repeat) {
        const double start = cpu_s();
        const reference_fem::SimplexSpace space(mesh, element_order);
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

}  // namespace experiments

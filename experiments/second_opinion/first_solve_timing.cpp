#include "experiments/second_opinion/first_solve_timing.hpp"

#include "experiments/second_opinion/calculix_deck.hpp"
#include "experiments/second_opinion/calculix_run.hpp"
#include "reference_fem/blas.hpp"

#include "pbs/geometry/stopwatch.hpp"

#include <algorithm>
#include <stdexcept>
#include <vector>

namespace experiments {
namespace {

double median(std::vector<double> values)
{
    const auto middle = values.begin() + values.size() / 2;
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

double wall_s(const std::string& program, const NodalProblem& problem, CalculixAnalysis analysis)
{
    const DeckOptions options{.analysis = analysis, .restart_file = false};
    const CalculixRun run = run_calculix(program, [&](std::ostream& deck) { write_calculix_deck(deck, problem, options); }, {});
    if (run.outcome != CalculixOutcome::finished)
        throw std::runtime_error(program + ": " + name_of(run.outcome) + ": " + last_words(run.output));
    return run.wall_s;
}

}  // namespace

FirstSolveTiming time_first_solve(const std::string& program, const pbs::TetMesh& mesh, int element_order, const Cantilever& cantilever,
                                  int repeats)
{
    reference_fem::use_one_blas_thread();
    std::vector<double> elements, solves, calculix, reading;
    FirstSolveTiming timing{static_cast<int>(mesh.rest.rows()), 0, repeats};
    for (int repeat = 0; repeat < repeats; ++repeat) {
        const pbs::Stopwatch stopwatch;
        const reference_fem::SimplexSpace space(mesh, element_order);
        elements.push_back(stopwatch.seconds());
        const NodalProblem problem = cantilever_problem(space, cantilever);
        const pbs::Stopwatch solve;
        linear_displacements(space, problem);
        solves.push_back(solve.seconds());
        timing.dofs = space.dofs();
        calculix.push_back(wall_s(program, problem, CalculixAnalysis::linear));
        reading.push_back(wall_s(program, problem, CalculixAnalysis::none));
    }
    timing.elements_s = median(elements);
    timing.solve_s = median(solves);
    timing.calculix_s = median(calculix);
    timing.reading_s = median(reading);
    return timing;
}

}  // namespace experiments

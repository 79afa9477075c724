#include "reference_fem/verification/calculix/second_opinion.hpp"

#include "reference_fem/verification/calculix/calculix_result.hpp"

namespace reference_fem {

using namespace reference_fem;

SecondOpinion second_opinion(const std::string& program, const AnsweredProblem& ours, const DeckOptions& options,
                             const CalculixLimits& limits)
{
    const CalculixRun run = run_calculix(
        program, [&](std::ostream& deck) { write_calculix_deck(deck, ours.problem, options); }, limits);
    SecondOpinion opinion;
    opinion.outcome = run.outcome;
    opinion.wall_s = run.wall_s;
    opinion.largest_displacement_m = ours.displacements.rowwise().norm().maxCoeff();
    if (run.outcome != CalculixOutcome::finished) {
        opinion.last_words = last_words(run.output);
        return opinion;
    }
    const CalculixDisplacements theirs = read_displacements(run.printed, run.restart, ours.displacements.rows());
    opinion.in_double = theirs.in_double;
    opinion.largest_difference_m = (theirs.displacements - ours.displacements).rowwise().norm().maxCoeff(&opinion.node);
    return opinion;
}

}  // namespace reference_fem

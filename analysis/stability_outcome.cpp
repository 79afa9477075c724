#include "analysis/stability_outcome.hpp"

#include "pbs/geometry/tet_volume.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace analysis {
namespace {

using Steps = std::vector<StabilityStep>;

// The part from numerator / denominator of the steps on.
std::size_t part(const Steps& steps, int numerator, int denominator)
{
    return steps.size() * numerator / denominator;
}

double mean_motion(const Steps& steps, std::size_t begin, std::size_t end)
{
    double sum = 0.0;
    for (std::size_t i = begin; i < end; ++i) sum += steps[i].motion;
    return end > begin ? sum / static_cast<double>(end - begin) : 0.0;
}

bool went_far(const Steps& steps, const StabilityBounds& bounds)
{
    return std::any_of(steps.begin() + part(steps, 2, 3), steps.end(), [&](const auto& step) { return step.reach > bounds.farthest; });
}

bool motion_grows(const Steps& steps, const StabilityBounds& bounds)
{
    const double first = mean_motion(steps, part(steps, 6, 9), part(steps, 7, 9));
    const double second = mean_motion(steps, part(steps, 7, 9), part(steps, 8, 9));
    const double third = mean_motion(steps, part(steps, 8, 9), steps.size());
    return third > bounds.rest_motion && second > bounds.growth * first && third > bounds.growth * second;
}

bool settled(const StabilityStep& step, const StabilityBounds& bounds)
{
    const bool near = std::isnan(step.from_undisturbed) || step.from_undisturbed < bounds.near_undisturbed;
    return step.solved && step.motion < bounds.rest_motion && step.inverted_tets == 0 && near;
}

// Steps at the end that are all settled.
int settled_at_the_end(const Steps& steps, const StabilityBounds& bounds)
{
    const auto last_unsettled = std::find_if(steps.rbegin(), steps.rend(), [&](const auto& step) { return !settled(step, bounds); });
    return static_cast<int>(last_unsettled - steps.rbegin());
}

}  // namespace

std::string name_of(StabilityOutcome outcome)
{
    switch (outcome) {
        case StabilityOutcome::converged:
            return "converged";
        case StabilityOutcome::bounded:
            return "bounded";
        case StabilityOutcome::inverted:
            return "inverted";
        case StabilityOutcome::diverged:
            return "diverged";
        case StabilityOutcome::not_finite:
            return "not_finite";
    }
    return "";
}

std::string criteria_text(const StabilityBounds& bounds)
{
    return fmt::format(
        "A body is disturbed, then held still. D is the diagonal of its rest bounding box; a vertex' place is the sphere about its posed\n"
        "bind point through its rest distance. The first that applies:\n\n"
        "| outcome | when |\n|---|---|\n"
        "| not_finite | a position is not finite in any step |\n"
        "| diverged | in the last third of the steps a vertex is farther than {:g} D from its place; or the largest motion a step, "
        "averaged "
        "over each third of them, is above {:g} D at last and grew twice by more than {:g} times |\n"
        "| inverted | a tet is inverted in the last step |\n"
        "| converged | in each of the last {} steps no vertex moved by {:g} D or more, no tet was inverted, the method reached what the "
        "step "
        "asked for and, where the same body set out undisturbed comes to rest, no vertex is {:g} D or more from that |\n"
        "| bounded | none of these: still moving, at rest elsewhere, or held up on the way (a Newton step that was not reached). It says "
        "that nothing worse happened, not that the shape is right |\n\n"
        "Recovery: still steps before the first from which on all are as `converged` asks.\n",
        bounds.farthest, bounds.rest_motion, bounds.growth, bounds.still_steps, bounds.rest_motion, bounds.near_undisturbed);
}

StabilityStep stability_step(const pbs::Positions& before, const pbs::Positions& after, const Places& places, const pbs::Tets& tets,
                             double diagonal_m, const pbs::Positions* undisturbed)
{
    StabilityStep step;
    step.finite = after.allFinite();
    if (!step.finite) return step;
    step.motion = (after - before).rowwise().norm().maxCoeff() / diagonal_m;
    step.reach = ((after - places.centres).rowwise().norm() - places.distance).maxCoeff() / diagonal_m;
    step.inverted_tets = static_cast<int>((pbs::tet_volumes(after, tets).array() < 0.0).count());
    if (undisturbed) step.from_undisturbed = (after - *undisturbed).rowwise().norm().maxCoeff() / diagonal_m;
    return step;
}

StabilityResult outcome_of(const std::vector<StabilityStep>& steps, int disturbed, const StabilityBounds& bounds)
{
    const bool finite = std::all_of(steps.begin(), steps.end(), [](const auto& step) { return step.finite; });
    if (steps.empty() || !finite) return {StabilityOutcome::not_finite, {}};
    if (went_far(steps, bounds) || motion_grows(steps, bounds)) return {StabilityOutcome::diverged, {}};
    if (steps.back().inverted_tets > 0) return {StabilityOutcome::inverted, {}};
    const int settled_steps = settled_at_the_end(steps, bounds);
    if (settled_steps < bounds.still_steps) return {StabilityOutcome::bounded, {}};
    return {StabilityOutcome::converged, std::max(0, static_cast<int>(steps.size()) - settled_steps - disturbed)};
}

}  // namespace analysis

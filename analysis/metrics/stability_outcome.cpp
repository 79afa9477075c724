#include "analysis/metrics/stability_outcome.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace analysis {
namespace {

using Steps = std::vector<StabilityStep>;

// The final motion of a body: the last third of the still steps, and at least the last step.
struct Ending {
    Steps::const_iterator begin, end;

    Ending(const Steps& steps, int disturbed) : end(steps.end())
    {
        const int still = std::max(0, static_cast<int>(steps.size()) - disturbed);
        begin = end - std::max(1, still / 3);
    }
};

double mean_motion(Steps::const_iterator begin, Steps::const_iterator end)
{
    return std::accumulate(begin, end, 0.0, [](double sum, const auto& step) { return sum + step.motion; }) /
           double(end - begin);
}

bool motion_grows(const Ending& ending, double put_in, const StabilityBounds& bounds)
{
    const auto third = (ending.end - ending.begin) / 3;
    if (third == 0) return false;
    const double first = mean_motion(ending.begin, ending.begin + third);
    const double second = mean_motion(ending.begin + third, ending.begin + 2 * third);
    const double last = mean_motion(ending.begin + 2 * third, ending.end);
    return last > put_in && last > bounds.rest_motion && second > bounds.growth * first &&
           last > bounds.growth * second;
}

bool settled(const StabilityStep& step, const StabilityBounds& bounds)
{
    const bool near = std::isnan(step.from_undisturbed) || step.from_undisturbed < bounds.near_undisturbed;
    return step.solved && step.motion < bounds.rest_motion && step.inverted_tets == 0 && near;
}

}  // namespace

std::string name_of(StabilityOutcome outcome)
{
    constexpr const char* names[] = {"converged", "bounded", "inverted", "diverged", "not_finite"};
    return names[static_cast<int>(outcome)];
}

std::string criteria_text(const StabilityBounds& bounds)
{
    return fmt::format(
        "A body is disturbed, then held still. D is the diagonal of its rest bounding box; a vertex' place is the "
        "sphere about its posed\n"
        "bind point through its rest distance. The first that applies:\n\n"
        "| outcome | when |\n|---|---|\n"
        "| not_finite | a position is not finite in any step |\n"
        "| diverged | in the last third of the still steps a vertex is farther than {:g} D from its place, by a step "
        "that was reached; or "
        "its motion a step, the largest of any vertex, averaged over each third of them, grew twice by more than {:g} "
        "times, to above "
        "{:g} D and to more than in any step of the disturbance |\n"
        "| inverted | a tet is inverted in the last step |\n"
        "| converged | in each of the last {} steps no vertex moved by {:g} D or more, no tet was inverted, the method "
        "reached what the "
        "step asked for and, where the same body set out undisturbed comes to rest, no vertex is {:g} D or more from "
        "that |\n"
        "| bounded | none of these: still moving, at rest elsewhere, or held up on the way (a Newton step that was not "
        "reached). It says "
        "that nothing worse happened, not that the shape is right |\n\n"
        "Recovery: still steps before the first from which on all are as `converged` asks.\n",
        bounds.farthest, bounds.growth, bounds.rest_motion, bounds.still_steps, bounds.rest_motion,
        bounds.near_undisturbed);
}

StabilityStep stability_step(const pbs::Positions& before, const pbs::Positions& after, const Places& places,
                             const pbs::Tets& tets, double diagonal_m, const pbs::Positions* undisturbed)
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

int settled_steps(const std::vector<StabilityStep>& steps, const StabilityBounds& bounds)
{
    const auto last_unsettled =
        std::find_if(steps.rbegin(), steps.rend(), [&](const auto& step) { return !settled(step, bounds); });
    return static_cast<int>(last_unsettled - steps.rbegin());
}

StabilityResult outcome_of(const std::vector<StabilityStep>& steps, int disturbed, const StabilityBounds& bounds)
{
    const bool finite = std::all_of(steps.begin(), steps.end(), [](const auto& step) { return step.finite; });
    if (steps.empty() || !finite) return {StabilityOutcome::not_finite, {}};
    const Ending ending(steps, disturbed);
    double put_in = 0.0;
    for (int i = 0; i < std::min(disturbed, static_cast<int>(steps.size())); ++i)
        put_in = std::max(put_in, steps[i].motion);
    const auto is_far = [&](const StabilityStep& step) { return step.solved && !(step.reach <= bounds.farthest); };
    if (std::any_of(ending.begin, ending.end, is_far) || motion_grows(ending, put_in, bounds))
        return {StabilityOutcome::diverged, {}};
    if (steps.back().inverted_tets > 0) return {StabilityOutcome::inverted, {}};
    const int settled = settled_steps(steps, bounds);
    if (settled < bounds.still_steps) return {StabilityOutcome::bounded, {}};
    return {StabilityOutcome::converged, std::max(0, static_cast<int>(steps.size()) - settled - disturbed)};
}

}  // namespace analysis

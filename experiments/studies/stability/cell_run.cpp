#include "experiments/studies/stability/cell_run.hpp"

#include "experiments/process/machine.hpp"
#include "experiments/process/terminal.hpp"
#include "experiments/studies/stability/driven_body.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>

namespace experiments {
namespace {

constexpr int settled_for_good = 50;  // steps at rest after which a run ends early
constexpr int given_up_after = 2;     // consecutive steps that were not reached, after which a run ends early

struct Course {
    std::vector<analysis::StabilityStep> steps;
    pbs::Positions last;  // [m], #V x 3
    int disturbed_steps = 0;
    std::vector<int> iterations;  // of the method, by step
};

bool is_over(const Course& course)
{
    const auto& steps = course.steps;
    const auto reached = std::find_if(steps.rbegin(), steps.rend(), [](const auto& step) { return step.solved; });
    if (!steps.back().finite || reached - steps.rbegin() >= given_up_after) return true;
    return static_cast<int>(steps.size()) >= course.disturbed_steps + settled_for_good &&
           analysis::settled_steps(steps) >= settled_for_good;
}

std::optional<int> iterations_until_reached(const Course& course)
{
    const auto reached = std::find_if(course.steps.begin(), course.steps.end(), [](const auto& step) { return step.solved; });
    if (reached == course.steps.end()) return std::nullopt;
    return std::accumulate(course.iterations.begin(), course.iterations.begin() + (reached - course.steps.begin()) + 1, 0);
}

Course follow(const StabilityCell& cell, const pbs::Positions* undisturbed)
{
    StabilityBody body(cell);
    const pbs::Character& character = body.character();
    const auto driven = make_driven_body(cell, character);
    Course course{{}, body.drive(0).blended, body.disturbed_steps(), {}};
    for (int step = 0; step < body.steps(); ++step) {
        stop_if_interrupted();
        const Drive drive = body.drive(step);
        const pbs::StepSummary step_summary = driven->advance(drive, cell.time_step_s);
        course.steps.push_back(analysis::stability_step(course.last, driven->positions(), {drive.bind_points, character.binding.distance},
                                                        character.mesh.tets, body.diagonal_m(), undisturbed));
        course.steps.back().solved = step_summary.outcome == pbs::Outcome::finished;
        course.iterations.push_back(step_summary.iterations);
        course.last = driven->positions();
        if (is_over(course)) break;
    }
    return course;
}

// The shape in which a body comes to rest that begins in the last pose, whether or not it has inverted tets.
std::optional<pbs::Positions> undisturbed_state(StabilityCell cell)
{
    cell.disturbance.stays = true;
    cell.disturbance.start = Start::none;
    Course course = follow(cell, nullptr);
    for (auto& step : course.steps) step.inverted_tets = 0;
    if (analysis::outcome_of(course.steps, course.disturbed_steps).outcome != analysis::StabilityOutcome::converged) return std::nullopt;
    return course.last;
}

// Cells that differ only in their disturbance share the undisturbed state.
const std::optional<pbs::Positions>& undisturbed_of(const StabilityCell& cell)
{
    static std::map<std::string, std::optional<pbs::Positions>> kept;
    const std::string key = setting_of(cell);
    const auto found = kept.find(key);
    return found != kept.end() ? found->second : kept.emplace(key, undisturbed_state(cell)).first->second;
}

}  // namespace

std::string endings_text()
{
    return fmt::format(
        "\nA run ends early when it is not finite, when the last {} steps all fulfil the bounds of `converged`, or when {} consecutive "
        "steps "
        "were\nnot reached (each further attempt would be expensive).\n",
        settled_for_good, given_up_after);
}

CellResult run_cell(const StabilityCell& cell)
{
    const double start_s = process_cpu_s();
    const std::optional<pbs::Positions>& undisturbed = undisturbed_of(cell);
    CellResult result;
    Course course = follow(cell, undisturbed ? &*undisturbed : nullptr);
    result.stability = analysis::outcome_of(course.steps, course.disturbed_steps);
    if (cell.disturbance.start != Start::none) result.iterations_until_reached = iterations_until_reached(course);
    result.steps_not_reached =
        static_cast<int>(std::count_if(course.steps.begin(), course.steps.end(), [](const auto& s) { return !s.solved; }));
    result.steps = std::move(course.steps);
    result.has_undisturbed = undisturbed.has_value();
    result.cpu_s = process_cpu_s() - start_s;
    return result;
}

}  // namespace experiments

#include "experiments/stability/cell_run.hpp"

#include "experiments/stability/driven_body.hpp"
#include "pbs/geometry/stopwatch.hpp"

#include <algorithm>

namespace experiments {
namespace {

struct Course {
    std::vector<analysis::StabilityStep> steps;
    pbs::Positions last;  // [m], #V x 3
    int disturbed_steps = 0;
};

Course follow(const StabilityCell& cell, const pbs::Positions* undisturbed)
{
    StabilityBody body(cell);
    const pbs::Character& character = body.character();
    const auto driven = make_driven_body(cell, character);
    Course course{{}, body.drive(0).blended, body.disturbed_steps()};
    for (int step = 0; step < body.steps(); ++step) {
        const Drive drive = body.drive(step);
        const bool solved = driven->advance(drive, cell.time_step_s);
        course.steps.push_back(analysis::stability_step(course.last, driven->positions(), {drive.bind_points, character.binding.distance},
                                                        character.mesh.tets, body.diagonal_m(), undisturbed));
        course.steps.back().solved = solved;
        course.last = driven->positions();
        if (!course.steps.back().finite) break;
    }
    return course;
}

// Where the body rests that set out on the last pose; inverted tets are no reason against it.
std::optional<pbs::Positions> undisturbed_state(StabilityCell cell)
{
    cell.disturbance.stays = true;
    cell.disturbance.start = Start::none;
    Course course = follow(cell, nullptr);
    for (auto& step : course.steps) step.inverted_tets = 0;
    if (analysis::outcome_of(course.steps, course.disturbed_steps).outcome != analysis::StabilityOutcome::converged) return std::nullopt;
    return course.last;
}

}  // namespace

CellResult run_cell(const StabilityCell& cell)
{
    const pbs::Stopwatch stopwatch;
    const std::optional<pbs::Positions> undisturbed = undisturbed_state(cell);
    CellResult result;
    Course course = follow(cell, undisturbed ? &*undisturbed : nullptr);
    result.stability = analysis::outcome_of(course.steps, course.disturbed_steps);
    result.steps_not_reached =
        static_cast<int>(std::count_if(course.steps.begin(), course.steps.end(), [](const auto& s) { return !s.solved; }));
    result.steps = std::move(course.steps);
    result.has_undisturbed = undisturbed.has_value();
    result.seconds = stopwatch.seconds();
    return result;
}

}  // namespace experiments

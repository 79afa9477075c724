// What became of a body after a disturbance: one of five outcomes, by bounds that are the same for every method.
//   steps.push_back(stability_step(before, after, places, mesh.tets, diagonal_m, undisturbed));   // every step
//   const StabilityResult result = outcome_of(steps, disturbed_steps);
// `bounded` says that nothing worse happened, not that the shape is right. Lengths are in diagonals of the rest bounding box.
#pragma once

#include "pbs/geometry/types.hpp"

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace analysis {

// The first that applies of not_finite, diverged, inverted, converged, bounded; criteria_text() says when.
enum class StabilityOutcome { converged, bounded, inverted, diverged, not_finite };
std::string name_of(StabilityOutcome outcome);  // as it is spelt in the enum

// The same for every method and body; criteria_text() says them in words.
struct StabilityBounds {
    double farthest = 1.0;           // of a vertex from its place [diagonals]
    double growth = 1.5;             // of the mean motion, from a ninth of the still steps to the next
    double rest_motion = 1e-5;       // of any vertex in a step [diagonals]
    double near_undisturbed = 1e-3;  // of any vertex from the undisturbed result [diagonals]
    int still_steps = 10;            // that a body is at rest before it counts as converged
};
std::string criteria_text(const StabilityBounds& bounds = {});  // the definitions in words, Markdown

// One step in figures.
struct StabilityStep {
    bool finite = true;                                                  // every position
    bool solved = true;                                                  // the method reached what the step asked for
    double motion = 0.0;                                                 // of the vertex that moved most in the step [diagonals]
    double reach = 0.0;                                                  // of the vertex farthest from its place [diagonals]
    double from_undisturbed = std::numeric_limits<double>::quiet_NaN();  // of the farthest vertex [diagonals]; not a number: no such state
    int inverted_tets = 0;                                               // of negative volume after the step
};

// Where each vertex belongs: on a sphere about a point [m] of the bone it hangs on.
struct Places {
    const pbs::Positions& centres;    // [m], #V x 3
    const Eigen::VectorXd& distance;  // [m], #V
};
// Positions [m], #V x 3; undisturbed: likewise, or null where there is no such state. Where `after` is not finite, nothing else is
// measured.
StabilityStep stability_step(const pbs::Positions& before, const pbs::Positions& after, const Places& places, const pbs::Tets& tets,
                             double diagonal_m, const pbs::Positions* undisturbed = nullptr);

// recovery_steps only where converged.
struct StabilityResult {
    StabilityOutcome outcome = StabilityOutcome::not_finite;  // the first that applies
    std::optional<int> recovery_steps;                        // of a body that converged: still steps before it was at rest for good
};
// disturbed: so many of the first steps; the others are still, and their last third tells what the body ended up doing. No steps:
// not_finite.
StabilityResult outcome_of(const std::vector<StabilityStep>& steps, int disturbed, const StabilityBounds& bounds = {});

// Steps at the end of which each is as `converged` asks.
int settled_steps(const std::vector<StabilityStep>& steps, const StabilityBounds& bounds = {});

}  // namespace analysis

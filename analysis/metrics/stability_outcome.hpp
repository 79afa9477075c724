// The outcome for a body after a disturbance: one of five, by bounds that are the same for every method.
//   steps.push_back(stability_step(before, after, places, mesh.tets, diagonal_m, undisturbed));   // every step
//   const StabilityResult result = outcome_of(steps, disturbed_steps);
// `bounded` means that nothing worse happened, not that the shape is right. Lengths are in diagonals of the rest
// bounding box.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace analysis {

// The first that applies of not_finite, diverged, inverted, converged, bounded; criteria_text() defines them.
enum class StabilityOutcome { converged, bounded, inverted, diverged, not_finite };
std::string name_of(StabilityOutcome outcome);  // as in the enum

// The same for every method and body; criteria_text() describes them in words.
struct StabilityBounds {
    double farthest = 1.0;           // distance of a vertex from its place [diagonals]
    double growth = 1.5;             // growth of the mean motion from one ninth of the still steps to the next
    double rest_motion = 1e-5;       // motion of any vertex in a step [diagonals]
    double near_undisturbed = 1e-3;  // distance of any vertex from the undisturbed result [diagonals]
    int still_steps = 10;            // steps that a body must be at rest to count as converged
};
std::string criteria_text(const StabilityBounds& bounds = {});  // the definitions in words, as Markdown

// The measured values of one step.
struct StabilityStep {
    bool finite = true;   // all positions are finite
    bool solved = true;   // the method reached the tolerance of the step
    double motion = 0.0;  // motion of the vertex that moved most in the step [diagonals]
    double reach = 0.0;   // distance of the farthest vertex from its place [diagonals]
    // distance of the farthest vertex [diagonals]; NaN if there is no undisturbed state
    double from_undisturbed = std::numeric_limits<double>::quiet_NaN();
    int inverted_tets = 0;  // tets with negative volume after the step
};

// The place of each vertex: on a sphere about a point [m] of the bone to which it is bound.
struct Places {
    const pbs::Positions& centres;    // [m], #V x 3
    const Eigen::VectorXd& distance;  // [m], #V
};
// Positions [m], #V x 3; undisturbed: likewise, or null if there is no such state. If `after` is not finite, nothing
// else is measured.
StabilityStep stability_step(const pbs::Positions& before, const pbs::Positions& after, const Places& places,
                             const pbs::Tets& tets, double diagonal_m, const pbs::Positions* undisturbed = nullptr);

// recovery_steps is set only for converged.
struct StabilityResult {
    StabilityOutcome outcome = StabilityOutcome::not_finite;  // the first that applies
    // the number of still steps after which a converged body stays at rest
    std::optional<int> recovery_steps;
};
// disturbed: the number of disturbed steps at the beginning. The other steps are still, and the last third of them
// decides how the body ended. Without steps the outcome is not_finite.
StabilityResult outcome_of(const std::vector<StabilityStep>& steps, int disturbed, const StabilityBounds& bounds = {});

// The number of steps at the end of the series that all meet the criterion of `converged`.
int settled_steps(const std::vector<StabilityStep>& steps, const StabilityBounds& bounds = {});

}  // namespace analysis

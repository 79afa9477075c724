// How sure it is that one point is nearer to the truth than another, where the reference by which both are measured is itself some way off.
//   certainty_of(diagram, pbs, delta_mush)
// Errors are distances: against the truth either may be larger or smaller by as much as the reference is off. Its bound presumes an order
// of convergence; that the second solution says the same is observed, and presumes nothing.
#pragma once

#include "experiments/studies/work_precision/diagram.hpp"

namespace experiments {

// Each implies those before it.
enum class Certainty {
    not_known,       // there is no second solution, or one of the two is the second solution itself
    one_solution,    // the nearer one is not the nearer to the second solution
    both_solutions,  // it is, but by no more than twice the reference's bound
    told_apart,      // by more than that
};

// `nearer` has the smaller error.
Certainty certainty_of(const Diagram& diagram, const DiagramPoint& nearer, const DiagramPoint& other);

// The least of it over all times from `from_ms` on, the best of `one` against the best of `other`; nothing where the other is never there.
std::optional<Certainty> certainty_from(const Diagram& diagram, const DeformerGroup& one, const DeformerGroup& other, double from_ms);

// To stand behind a sentence; empty where the two are told apart.
std::string words_of(Certainty certainty, const Diagram& diagram);

}  // namespace experiments

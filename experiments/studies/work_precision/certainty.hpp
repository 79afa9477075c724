// How certain it is that one point is nearer to the exact solution than another, where the reference for both has an error of its own.
//   certainty_of(diagram, pbs, delta_mush)
// Errors are distances: relative to the exact solution, each may be larger or smaller by the error of the reference. The bound of that
// error assumes an order of convergence. That the second solution leads to the same result is an observation and assumes nothing.
#pragma once

#include "experiments/studies/work_precision/diagram.hpp"

namespace experiments {

// Each value implies those before it.
enum class Certainty {
    not_known,       // there is no second solution, or one of the two is the second solution itself
    one_solution,    // the nearer point is not nearer to the second solution
    both_solutions,  // it is, but by at most twice the reference's bound
    told_apart,      // it is, by more than that
};

// `nearer` has the smaller error.
Certainty certainty_of(const Diagram& diagram, const DiagramPoint& nearer, const DiagramPoint& other);

// The least certainty over all times from `from_ms` on, for the best points of both groups. Nothing where `other` has no points.
std::optional<Certainty> certainty_from(const Diagram& diagram, const DeformerGroup& one, const DeformerGroup& other, double from_ms);

// A remark that follows a sentence. Empty for told_apart.
std::string words_of(Certainty certainty, const Diagram& diagram);

}  // namespace experiments

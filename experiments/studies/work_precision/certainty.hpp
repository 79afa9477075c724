// Whether one point is certainly nearer to the exact solution than another, where the reference for both has an error of its own.
//   is_certain(diagram, pbs, delta_mush)
// Errors are distances: relative to the exact solution, each may be larger or smaller by the error of the reference.
#pragma once

#include "experiments/studies/work_precision/diagram.hpp"

namespace experiments {

// `nearer` has the smaller error. Nothing where the reference's own error is not known.
std::optional<bool> is_certain(const Diagram& diagram, const DiagramPoint& nearer, const DiagramPoint& other);

// Whether that holds at all times from `from_ms` on, for the best points of both groups. Nothing where it is not known at one of them, or
// `other` has no points.
std::optional<bool> is_certain_from(const Diagram& diagram, const DeformerGroup& one, const DeformerGroup& other, double from_ms);

// A remark that follows a sentence. Empty where it is certain.
std::string remark_on(std::optional<bool> certain, const Diagram& diagram);

}  // namespace experiments

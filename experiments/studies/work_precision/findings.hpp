// The sentences about a work-precision diagram: which group of deformers is nearest within a time, which one passes another from which time
// on, whether the physics is worth its time, and what the reference's own error leaves undecided. Each comparison is marked as decided, or
// with the reason why not (diagram.hpp).
#pragma once

#include "experiments/studies/work_precision/diagram.hpp"

namespace experiments {

// One line per finding, without line ends.
std::vector<std::string> findings(const Diagram& diagram);

// The front of all points in aligned columns: ms per frame with quartiles, error, deformer and setting.
std::string front_text(const Diagram& diagram);

std::string ms_text(double ms);  // 0.1 ms, 110 ms

}  // namespace experiments

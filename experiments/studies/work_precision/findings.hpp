// The sentences about a work-precision diagram: the fastest groups, which group is nearest from which time on, whether the physics is worth
// its time, and what the reference's own error leaves undecided. A comparison that lies within that error states so (certainty.hpp).
#pragma once

#include "experiments/studies/work_precision/diagram.hpp"

namespace experiments {

// One line per finding, without line ends.
std::vector<std::string> findings(const Diagram& diagram);

// The front of all points in aligned columns: ms per frame with quartiles, error, deformer and setting.
std::string front_text(const Diagram& diagram);

// All diagrams, one line each: the least error of each group of deformers, and its time in ms.
std::string best_text(const std::vector<Diagram>& diagrams);

}  // namespace experiments

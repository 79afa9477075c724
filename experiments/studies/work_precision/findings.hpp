// A work-precision diagram in words, each from its figures: who alone is so quick, who is nearest from which time on, whether the physics
// is worth its time, and what the reference's own error leaves undecided: each comparison that lies within it says so (certainty.hpp).
#pragma once

#include "experiments/studies/work_precision/diagram.hpp"

namespace experiments {

// One line a finding, without line ends.
std::vector<std::string> findings(const Diagram& diagram);

// The front of all points, aligned: ms a frame with quartiles, error, who.
std::string front_text(const Diagram& diagram);

// All diagrams on one screen, a line each: how near each group of deformers comes at its best, and after how many ms.
std::string best_text(const std::vector<Diagram>& diagrams);

// Whether the physics is worth its time: delta mush against PBS and XPBD within the time of delta mush at its best, which is
// chosen with hindsight.
std::string physics_text(const Diagram& diagram);

}  // namespace experiments

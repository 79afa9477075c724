// Movements of a body by name, such as elbow_flexion or hip_flexion+knee_flexion (scenes/movements.toml).
#pragma once

#include "experiments/scene/motion.hpp"

#include <string>
#include <utility>
#include <vector>

namespace experiments {

// The rest pose, and from it through each movement at an even rate: frame k spec.frames + i has i / spec.frames of
// movement k. Between two movements the body is back at rest within one step. InputErrors: an unknown movement, a joint
// that the skeleton lacks, and a straight limb where its bend at rest is the axis.
pbs::Motion through_movements(const MotionSpec& spec, const pbs::Skeleton& skeleton, const std::string& scene_file);
std::vector<std::string> movements_of(const pbs::Skeleton& skeleton);  // those whose joints it has, pairs last
std::vector<std::pair<std::string, std::string>> listed_movements();   // name and meaning
std::vector<std::string> joints_of(const std::string& movement);
bool is_twist(const std::string& movement);  // about the bones' own axes alone

}  // namespace experiments

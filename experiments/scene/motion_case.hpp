// The motion of a scene on the skeleton of a character.
#pragma once

#include "experiments/scene/scene.hpp"

namespace experiments {

pbs::Motion make_motion(const MotionSpec& spec, const pbs::Skeleton& skeleton, const std::string& scene_file);

}  // namespace experiments

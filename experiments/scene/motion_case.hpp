// What moves: the scene's motion on a character's skeleton.
#pragma once

#include "experiments/scene/scene.hpp"

namespace experiments {

pbs::Motion make_motion(const MotionSpec& spec, const pbs::Skeleton& skeleton, const std::string& scene_file);

}  // namespace experiments

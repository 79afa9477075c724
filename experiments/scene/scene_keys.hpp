// The keys of a scene: its own, and those of every registered deformer.
#pragma once

#include "experiments/settings/scene_schema.hpp"

namespace experiments {

std::vector<SceneKey> character_and_motion_keys();
std::vector<SceneKey> output_keys();

SceneSchema scene_schema();  // all of them, the deformers' in between

}  // namespace experiments

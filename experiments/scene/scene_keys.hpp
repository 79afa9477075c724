// The keys of a scene, and those of all registered deformers.
#pragma once

#include "experiments/settings/scene_schema.hpp"

namespace experiments {

std::vector<SceneKey> character_and_motion_keys();
std::vector<SceneKey> output_keys();

SceneSchema scene_schema();  // all keys; those of the deformers come before the output keys

}  // namespace experiments

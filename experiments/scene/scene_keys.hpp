// The keys of a scene: those of its character, motion and output, and those of every registered deformer.
#pragma once

#include "experiments/settings/scene_schema.hpp"

namespace experiments {

SceneSchema scene_schema();

}  // namespace experiments

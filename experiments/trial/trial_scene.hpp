// The scene that `pbskin try` makes of a model: all that a user would otherwise write by hand.
#pragma once

#include "experiments/scene/scene.hpp"

#include <string>
#include <vector>

namespace experiments {

struct TrialOptions {
    std::string model;      // the file, relative to the working folder
    std::string animation;  // one of the model's by name, or a clip's file; empty: the first animation
    std::string skeleton;   // of a model without joints: a file, or human
    std::string folder;     // where scene.toml will be
    int frames = 60;        // at most, distributed over the motion
    int vertices = 0;       // wanted of the tets; 0: the default of models
    double scale = 1.0;
    bool reference = true, allow_partial = false;
};

// The text of scene.toml, and what the user should know about choices that were made, a sentence each. InputErrors are those of read_model
// and read_clip, fewer than two frames, a scale beyond 1e-6 to 1e6, and names that are not UTF-8, which a scene cannot hold.
struct TrialScene {
    std::string text;
    std::vector<std::string> remarks;
};
TrialScene trial_scene(const TrialOptions& options);

}  // namespace experiments

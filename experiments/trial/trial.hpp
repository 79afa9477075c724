// The scene that `pbskin try` makes of a model: all that a user would otherwise write by hand.
#pragma once

#include "experiments/scene/scene.hpp"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace experiments {

struct TrialOptions {
    std::string model;      // the file, relative to the working folder
    std::string animation;  // one of the model's by name, or a clip's file; empty: the first one that moves
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
    nlohmann::json animations;  // those of the model, in the order of the file: [{name, duration_s, largest_rotation_deg of a joint}]
};
TrialScene trial_scene(const TrialOptions& options);

// The scene of an earlier trial of the model in options.folder, which a new one replaces; empty: there is none. An InputError where the
// folder has the trial of another model, a scene that a user wrote or changed, or other files that a trial would replace.
std::string earlier_trial_scene(const TrialOptions& options);

// The results of a trial, computed from the records of its run.

// The facts of try.json: the model as the run read it (joints, dropped joints with reasons, containers, bind pose, unit, weights), the
// motion with its matched joints, the run's warnings, and
//   volume        per deformer the lowest and highest change of the volume over the frames [%], and the most inverted tets in a frame
//   joints        the two joints at which lbs loses most volume, with the mean change there of lbs and pbs [% of the joints' volume]
//   nearer        number of frames in which pbs is nearer to the reference than lbs, of how many that can be compared
//   frame_ms      median time of a frame, per deformer
// An InputError where the run's records are missing or damaged.
nlohmann::json trial_facts(const std::string& folder);

// One sentence per fact that the records hold.
std::string trial_sentence(const nlohmann::json& facts);

}  // namespace experiments

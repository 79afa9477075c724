// A scene: which character, what moves it, which deformers, what is written. Read from TOML (every key: manual.md, `pbskin explain`).
#pragma once

#include "experiments/deformers/deformer_spec.hpp"
#include "experiments/scene/error_bar.hpp"
#include "pbs/character/bodies.hpp"
#include "pbs/skinning/pose.hpp"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace experiments {

struct MotionSpec {
    std::string joint;                    // a sweep of this joint
    pbs::Vec3 axis = pbs::Vec3::UnitX();  // in rest world axes, of any length
    double angle_deg = 0.0;               // of the last frame
    int frames = 0;
    std::string clip;  // or a clip: its path
    double start_s = 0.0, duration_s = 0.0, rate_hz = 100.0;
    double time_step_s = 0.01;
};

struct OutputSpec {
    int frames_every = 1;                                 // 0: none but `frames`
    std::vector<int> frames;                              // by number
    bool errors = true, sections = true, surface = true;  // groups of metrics

    bool writes(int frame) const;
};

struct Scene {
    std::string name, file;
    pbs::CharacterSource character;
    MotionSpec motion;
    std::vector<DeformerSpec> deformers;
    std::string reference;  // name of the deformer that errors are measured against; empty: none
    ErrorBar error_bar = ErrorBar::none;
    OutputSpec output;
    nlohmann::json resolved;  // every key and value, for run.json; paths as the scene has them
};

// The first deformer with options of this type; null where there is none.
template <typename Options>
const DeformerSpec* find_deformer_with(const Scene& scene)
{
    for (const DeformerSpec& spec : scene.deformers)
        if (options_if<Options>(spec)) return &spec;
    return nullptr;
}

// Reads a scene file, or a built-in scene by name (`pbskin list scenes`).
Scene read_scene(const std::string& file_or_name, const std::vector<std::string>& overrides);

// `resolved` and the options of every deformer, a study's own included: what a run is the result of.
nlohmann::json resolved_with_deformers(const Scene& scene);
inline nlohmann::json to_json(const Scene& scene)
{
    return resolved_with_deformers(scene);
}

struct BuiltInScene {
    std::string name, text, meaning;
};
const std::vector<BuiltInScene>& built_in_scenes();

}  // namespace experiments

// A scene: a character, its motion, the deformers and the output. It is read from TOML. `pbskin explain KEY` and
// manual.md explain the keys.
#pragma once

#include "experiments/characters/bodies.hpp"
#include "experiments/deformers/deformer.hpp"
#include "experiments/scene/motion.hpp"
#include "experiments/settings/option_names.hpp"
#include "experiments/settings/scene_values.hpp"

#include <nlohmann/json.hpp>

#include <limits>
#include <string>
#include <vector>

namespace experiments {

struct DeformerKind;
template <typename Options>
class OptionFields;

struct OutputSpec {
    int frames_every = 1;                                 // every n-th frame is written; 0: only `frames`
    std::vector<int> frames;                              // further frames, by number
    bool errors = true, sections = true, surface = true;  // groups of metrics
    bool glb = false;           // the surface of each deformer in the written frames, as one .glb file
    bool surface_files = true;  // and as a .vtp file per frame; no key of a scene
    // of all .glb files together, which then have fewer frames; no key
    double most_glb_bytes = std::numeric_limits<double>::infinity();
    double most_skin_bytes = std::numeric_limits<double>::infinity();  // of the files of the artist's surface; no key

    bool writes(int frame) const;
};

// The further solutions that bound the distance of the reference from the limit of ever finer tets: none, or both
// element orders on its tets and on tets that are refined once.
enum class ErrorBar { none, both };

NAMED_OPTIONS(ErrorBar, none, both)

struct Scene {
    std::string name, file;
    pbs::CharacterSource character;
    MotionSpec motion;
    std::vector<DeformerSpec> deformers;
    std::string reference;  // name of the deformer that errors are measured against; empty: none
    ErrorBar error_bar = ErrorBar::none;
    double reference_seconds = 0.0;  // of processor time, for all of its frames; 0: no limit
    OutputSpec output;
    nlohmann::json resolved;  // every key and value, for run.json; paths as in the scene
};

// The first deformer with options of this type; null: there is none.
template <typename Options>
const DeformerSpec* find_deformer_with(const Scene& scene)
{
    for (const DeformerSpec& spec : scene.deformers)
        if (options_if<Options>(spec)) return &spec;
    return nullptr;
}

// Reads a scene file, or a built-in scene by name (`pbskin list scenes`).
Scene read_scene(const std::string& file_or_name, const std::vector<std::string>& overrides);

// The deformers of all [[kind]] tables, including those that the scene does not use. InputError for a name that is no
// identifier, is used twice or is that of a kind.
std::vector<DeformerSpec> listed_deformers(const SceneValues& values);

// `resolved` and the options of every deformer, including those that only studies set: all that the result of a run
// depends on.
nlohmann::json to_json(const Scene& scene);

struct BuiltInScene {
    std::string name, text, meaning;
};
const std::vector<BuiltInScene>& built_in_scenes();

// Messages for the user; each is one sentence.
struct Remarks {
    std::vector<std::string> warnings, notes;  // a result is doubtful; nothing is wrong
};

// All keys of a scene, those of the deformers among them: of these kinds, or of all that are registered.
SceneSchema scene_schema(const std::vector<DeformerKind>& kinds);
SceneSchema scene_schema();

// The keys that are members of these structs.
const OptionFields<pbs::CharacterSource>& character_fields();
const OptionFields<MotionSpec>& motion_fields();
const OptionFields<OutputSpec>& output_fields();

}  // namespace experiments

// The list of all deformers. Scenes, `pbskin list`, `explain`, records and metrics take from it what they need of a
// deformer, so that code depends on its name only where a study is about that deformer. README.md describes how to add
// one.
#pragma once

#include "experiments/deformers/deformer.hpp"
#include "experiments/settings/scene_values.hpp"

#include <nlohmann/json_fwd.hpp>

#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace experiments {

// Properties of a deformer that other code may read without knowing its kind.
struct DeformerTraits {
    std::string order = {};         // order of projection; empty: it projects nothing
    std::string precision = "f64";  // of its arithmetic
    bool packed = false;  // several constraints, vertices or tets per instruction, rather than one after the other
    std::optional<int> iterations = {};  // per frame
    int threads = 1;                     // the largest number of threads that a step uses
    bool sleeps = false;                 // its records have a share of sleeping constraints
    bool has_small_strain = false;       // it takes a rotation for a strain of 1 - cos(rotation)
    bool is_negative_control = false;    // its breakdown is an expected result and no failure
    bool blends_linearly = false;        // inverted tets in the first frame point to its weights or its bind pose
    bool solves_equations = false;       // a frame that has inverted tets or did not converge is no solution
    bool has_own_clock = false;          // it works in another process, so that only StepSummary::seconds has its time
};

// kind_of (deformer_kind.hpp) fills all of it from the struct of options and the class of the deformer.
struct DeformerKind {
    std::string name;          // in scenes and records
    std::string meaning = {};  // a line of `pbskin list deformers`
    std::function<std::unique_ptr<Deformer>(const DeformerSpec& spec)> make = {};

    // For a kind with options:
    std::any options = {};                      // the defaults
    std::vector<SceneKey> keys = {};            // of its tables in a scene
    std::vector<RenamedKey> renamed_keys = {};  // of an earlier release, which scenes may still have
    bool has_list = false;    // each [[kind]] table of a scene is a deformer, named by the table's key `name`
    bool needs_list = false;  // and there is none without a table
    // Sets options and variant from a table of a scene (pbs, fem.0). InputError for keys that contradict each other.
    std::function<void(const SceneValues& values, const std::string& table, DeformerSpec& spec)> read = {};
    std::function<nlohmann::json(const DeformerSpec& spec)> options_json = {};
    std::function<DeformerTraits(const DeformerSpec& spec)> traits = {};  // null: the default ones
};

const std::vector<DeformerKind>& deformer_kinds();
void add_deformer_kind(DeformerKind kind);                        // for programs with deformers of their own
const DeformerKind* find_deformer_kind(const std::string& name);  // null: there is no such kind

// Each is defined in the file of its deformer.
DeformerKind lbs_kind();
DeformerKind dqs_kind();
DeformerKind delta_mush_kind();
DeformerKind direct_delta_mush_kind();
DeformerKind correctives_kind();
DeformerKind pbs_kind();
DeformerKind pbs_author_kind();
DeformerKind xpbd_kind();
DeformerKind xpbd_small_steps_kind();
DeformerKind quasi_newton_kind();
DeformerKind vbd_kind();
DeformerKind warped_newton_kind();
DeformerKind xpbd_neo_hookean_kind();
DeformerKind projective_dynamics_kind();
DeformerKind fem_kind();
DeformerKind external_kind();

DeformerSpec default_spec(const std::string& kind);  // named and labelled by its kind
std::unique_ptr<Deformer> make_deformer(const DeformerSpec& spec);
DeformerTraits traits_of(const DeformerSpec& spec);
nlohmann::json to_json(const DeformerSpec& spec);  // name, label, kind, variant and options, for records

}  // namespace experiments

// The deformers that are compared, one entry each: its ladder of iterations, which are the axis of its work, the grid of settings that are
// tried at each of them, and its codes (packed f32, plain f64). An entry names keys of a scene (`pbskin explain KEY`), so that adding a
// deformer is an entry. Entries whose kind or keys do not exist in this program are skipped, and so are settings and codes.
//   for (const ComparedDeformer& entry : compared_deformers())
//       spec_with(entry, scene, {.iterations = 24, .change = entry.grid[0], .code = entry.codes[0]});
// Seven further entries are single changes to PBS. They are measured like the others, but no front has them: gains.hpp decides which one
// gains most over PBS in equal time. Finite elements have laws, element orders and meshes instead; point_setting.cpp adds them.
#pragma once

#include "experiments/deformers/deformer.hpp"
#include "experiments/scene/scene.hpp"

#include <optional>
#include <string>
#include <vector>

namespace experiments {

// Keys of a scene with their values, as for --set: "pbs.k_stretch=0.5".
using KeyValues = std::vector<std::string>;

// One place of the grid of settings. Empty: the deformer as the scene or the default sets it.
struct SettingChange {
    KeyValues keys = {};
    double young_factor = 1.0;  // on Young's modulus of young_key

    bool operator==(const SettingChange&) const = default;
};
// An identifier: k_stretch_0.9+stiffness_exponent, stiffness_factor_4. Empty: no change.
std::string name_of(const SettingChange& change);

struct ComparedDeformer {
    std::string name = {};     // in the records
    std::string kind = {};     // that is registered
    std::string group = {};    // the group of deformers that it is shown with; empty: the name
    std::string weights = {};  // of a [[kind]] table with weights of its own; empty: no such table
    KeyValues fixed = {};      // of all its settings
    std::string iterations_key = {};
    std::vector<int> iterations = {};      // the ladder; empty: it does not iterate
    std::vector<int> few_iterations = {};  // part of it: on other meshes, and in the quick form
    std::vector<SettingChange> grid = {{}};
    std::vector<KeyValues> codes = {{}};           // packed first; one: it has no other code
    std::string young_key = {}, poisson_key = {};  // take the reference's material
    bool smooth_weights = false;                   // the character has weights that are harmonic where Eq. 2 blends
    bool k_by_edge_length = false;                 // k_stretch_length_m is such that the mean of k over the edges is k_stretch
};

const std::vector<ComparedDeformer>& compared_deformers();
const std::vector<ComparedDeformer>& changes_to_pbs();
inline const std::string baseline = "pbs";               // with whose first code and default setting each change is compared
inline const std::string control = "other_stiffnesses";  // no change to the method: other values of its k_stretch and k_bind

bool is_available(const ComparedDeformer& entry);
std::vector<SettingChange> grid_of(const ComparedDeformer& entry);  // whose keys exist; the default setting first
std::vector<KeyValues> codes_of(const ComparedDeformer& entry);     // whose keys exist; an empty one if the deformer has one code

struct SettingChoice {
    std::optional<int> iterations = {};
    SettingChange change = {};
    KeyValues code = {};
};
// The entry's deformer with these settings and the others of the scene, which is a built-in one. InputError for a key that does not exist.
DeformerSpec spec_with(const ComparedDeformer& entry, const Scene& scene, const SettingChoice& choice);

// Deformers that are one entry in tables and figures: xpbd and xpbd_small_steps, or the laws of nonlinear finite elements.
struct DeformerGroup {
    std::string key;
    std::vector<std::string> deformers;
    bool is_external = false;  // one deformer of the user's own
};
const std::vector<DeformerGroup>& deformer_groups();
// These groups, followed by one for each of these deformers of the user's own.
std::vector<DeformerGroup> groups_with(const std::vector<std::string>& external);

// Deformers of the user's own in the comparison: the [[external]] tables of a file, which is written like a scene. An entry has no ladder
// of iterations, no grid of settings and one code, so that it is one point per pose, on the case's own mesh. Throws an InputError for a
// file that cannot be read, has no such table or other tables, a name that is that of a compared deformer or used twice, a program that
// cannot be started, and a library that cannot be loaded. Paths are relative to the file. Libraries are loaded in another process.
//   of.external = external_entries("mine.toml");
std::vector<DeformerSpec> external_entries(const std::string& file);

}  // namespace experiments

// The deformers that are compared, and the settings of each.
//   for (const Setting& setting : settings_of(scene, {.other_vertices = {600}})) ...
// A deformer is an entry of cases.toml: its ladder of iterations, which are the axis of its work, the grid of values that are tried with
// each of them, and its codes (packed f32, plain f64). A setting is one number of iterations on one mesh with one value of the grid in one
// code. An entry names keys of a scene (`pbskin explain KEY`). Entries whose kind or keys do not exist in this program are skipped, and so
// are values and codes. Further entries are single changes to PBS. They are measured like the others, but no front has them: gains.hpp
// decides which one gains most over PBS in equal time. On other meshes of the body a deformer runs a part of its ladder with the default
// value. Finite elements have laws, element orders and meshes instead. For each place on the axis of work (iterations, substeps, element
// order and mesh), one value of the grid is chosen on other poses than those that are shown (diagram.hpp).
#pragma once

#include "analysis/records/tables.hpp"
#include "experiments/deformers/external/external_deformers.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/scene/scene.hpp"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <vector>

namespace experiments {

// Keys of a scene with their values, as for --set: "pbs.k_stretch=0.5".
using KeyValues = std::vector<std::string>;

// One value of the grid, in cases.toml a list of keys: ["pbs.k_stretch=0.5"], ["young_factor=4"]. Empty: the deformer as the scene or the
// default sets it.
struct GridValue {
    KeyValues keys = {};
    double young_factor = 1.0;  // on Young's modulus of young_key

    bool operator==(const GridValue&) const = default;
};
// An identifier: k_stretch_0.9+stiffness_exponent, stiffness_factor_4. Empty: the default value.
std::string name_of(const GridValue& value);

struct ComparedDeformer {
    std::string name = {};                  // in the records
    std::string kind = {};                  // that is registered
    std::string group = {};                 // the group of deformers that it is shown with; empty: the name
    std::string of_class = {}, knows = {};  // `class` and `knows` in cases.toml
    std::string weights = {};               // of a [[kind]] table with weights of its own; empty: no such table
    KeyValues fixed = {};                   // of all its settings
    std::string iterations_key = {};
    std::vector<int> iterations = {};      // the ladder; empty: it does not iterate
    std::vector<int> few_iterations = {};  // part of it: on other meshes, and in the quick form
    std::vector<GridValue> grid = {{}};
    std::vector<KeyValues> codes = {{}};           // packed first; one: it has no other code
    std::string young_key = {}, poisson_key = {};  // take the reference's material
    bool smooth_weights = false;                   // the character has weights that are harmonic where Eq. 2 blends
    bool k_by_edge_length = false;                 // k_stretch_length_m is such that the mean of k over the edges is k_stretch
};

const std::vector<ComparedDeformer>& compared_deformers();
const std::vector<ComparedDeformer>& changes_to_pbs();
inline const std::string baseline = "pbs";               // with whose first code and default value each change is compared
inline const std::string control = "other_stiffnesses";  // no change to the method: other values of its k_stretch and k_bind

bool is_available(const ComparedDeformer& entry);
std::vector<GridValue> grid_of(const ComparedDeformer& entry);   // whose keys exist; the default value first
std::vector<KeyValues> codes_of(const ComparedDeformer& entry);  // whose keys exist; an empty one if the deformer has one code

struct SettingChoice {
    std::optional<int> iterations = {};
    GridValue value = {};
    KeyValues code = {};
};
// The entry's deformer with these settings and the others of the scene, which is a built-in one. InputError for a key that does not exist.
DeformerSpec spec_with(const ComparedDeformer& entry, const Scene& scene, const SettingChoice& choice);

// Deformers that are one entry in tables and figures: xpbd and xpbd_small_steps, or the laws of nonlinear finite elements.
struct DeformerGroup {
    std::string key;
    std::vector<std::string> deformers;
    bool is_external = false;  // one deformer of the user's own
    std::string of_class = {};
};
const std::vector<DeformerGroup>& deformer_groups();
// These groups, followed by one for each of these deformers of the user's own.
std::vector<DeformerGroup> groups_with(const std::vector<std::string>& external);
// The classes of these groups, each with all of its deformers.
std::vector<DeformerGroup> classes_of(const std::vector<DeformerGroup>& groups);

// Deformers of the user's own in the comparison: the [[external]] tables of a file, which is written like a scene. An entry has no ladder
// of iterations, no grid and one code, so that it is one setting per pose, on the case's own mesh. Throws an InputError for a
// file that cannot be read, has no such table or other tables, a name that is that of a compared deformer or used twice, a program that
// cannot be started, and a library that cannot be loaded. Paths are relative to the file. Libraries are loaded in another process.
//   of.external = external_entries("mine.toml");
std::vector<DeformerSpec> external_entries(const std::string& file);

struct Setting {
    std::string deformer;  // its front: lbs, dqs, delta_mush, pbs, xpbd, xpbd_small_steps, fem_linear, ...
    DeformerSpec spec;
    std::optional<int> iterations = {};   // of its ladder
    std::string tuned = {};               // the value of its grid, see name_of(GridValue)
    int vertices = 0;                     // wanted size of another mesh of the body; 0: the case's own
    bool refined = false;                 // on the case's own tets, each cut into eight
    const ComparedDeformer* change = {};  // the change to PBS that it is a setting of; null: of none

    bool is_external() const { return options_if<ExternalOptions>(spec) != nullptr; }  // a deformer of the user's own
    bool on_own_mesh() const { return vertices == 0 && !refined; }

    bool is_newton() const
    {
        const FemOptions* fem = options_if<FemOptions>(spec);
        return fem && fem->model != reference_fem::Model::linear;
    }
    // Linear elements on the case's own tets with the law of the deformers that minimise an energy: the limit of these deformers.
    bool is_limit_of_deformers() const
    {
        const FemOptions* fem = options_if<FemOptions>(spec);
        return fem && fem->model == reference_fem::Model::stable_neo_hookean && fem->element_order == 1 && on_own_mesh();
    }
};

// The values that distinguish a setting from the others. A field that the deformer does not have is empty.
struct SettingKey {
    std::string deformer;  // as in Setting
    std::optional<int> iterations = {};
    std::optional<double> k_stretch = {};
    std::string order = {}, precision = {};
    std::optional<int> substeps = {}, element_order = {};
    std::optional<int> wanted_vertices = {};  // of another mesh of the body
    bool refined = false;
    std::string tuned = {};  // the value of the grid; empty: the default one
    bool packed = false;     // code that computes several constraints, vertices or tets per instruction
    // The values that the deformer takes from the reference: material, attachment (its springs), start (the guess that these determine).
    std::string knows = {};

    // f64 code that is not packed. A deformer of the user's own, whose code is not known, counts as such.
    bool is_plain() const { return precision != "f32" && !packed; }
    bool operator==(const SettingKey&) const = default;
    auto operator<=>(const SettingKey&) const = default;
};
SettingKey key_of(const Setting& setting);
SettingKey without_grid_value(SettingKey key);             // the same for settings that differ in the value of the grid alone
const analysis::Columns<SettingKey>& setting_columns();    // all fields except the deformer; tuned and packed are in the group "code"
const analysis::Columns<SettingKey>& point_key_columns();  // with the deformer, first

struct SettingRange {
    bool in_short = false;                 // parts of the ladders and of the grids
    bool quadratic = true;                 // neo-Hookean flesh on quadratic elements too
    std::vector<int> other_vertices = {};  // sizes of other meshes of the body
    std::vector<int> without_fem = {};     // further sizes, on which no finite elements are solved
    int quadratic_up_to = 1000;            // sizes of other meshes on which the nonlinear law has quadratic elements too
    bool refined = false;                  // neo-Hookean flesh on the case's own tets, each cut into eight
    bool changes = false;                  // the changes to PBS
};
nlohmann::json to_json(const SettingRange& range);

// The scene, a built-in one, gives the options that are not varied: its pbs, and the material of its first [[fem]].
std::vector<Setting> settings_of(const Scene& scene, const SettingRange& range);

// A digest in 32 hexadecimal digits of everything that the settings' rows depend on: their options and meshes.
std::string digest_of(const std::vector<Setting>& settings);

}  // namespace experiments

// The points of a work-precision diagram: each deformer at many settings.
//   for (const PointSetting& setting : point_settings(scene, {.other_vertices = {600}})) ...
// A rung is a place on the axis of work: iterations, substeps, element order and mesh. At each rung a deformer has the settings of its grid
// (compared_deformers.hpp), of which one is chosen on other poses than those that are shown (diagram.hpp). On other meshes of the
// body a deformer runs a part of its ladder with its default setting. Finite elements have laws, element orders and meshes.
#pragma once

#include "analysis/records/tables.hpp"
#include "experiments/deformers/external/external_deformers.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/studies/work_precision/compared_deformers.hpp"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <vector>

namespace experiments {

struct PointSetting {
    std::string deformer;  // its front: lbs, dqs, delta_mush, pbs, xpbd, xpbd_small_steps, fem_linear, ...
    DeformerSpec spec;
    std::optional<int> iterations = {};   // of its ladder
    std::string tuned = {};               // the setting of its grid, see name_of(SettingChange)
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
    std::string deformer;  // as in PointSetting
    std::optional<int> iterations = {};
    std::optional<double> k_stretch = {};
    std::string order = {}, precision = {};
    std::optional<int> substeps = {}, element_order = {};
    std::optional<int> wanted_vertices = {};  // of another mesh of the body
    bool refined = false;
    std::string tuned = {};  // the setting of the grid; empty: the default one
    bool packed = false;     // code that computes several constraints, vertices or tets per instruction

    // f64 code that is not packed. A deformer of the user's own, whose code is not known, counts as such.
    bool is_plain() const { return precision != "f32" && !packed; }
    bool operator==(const SettingKey&) const = default;
    auto operator<=>(const SettingKey&) const = default;
};
SettingKey key_of(const PointSetting& setting);
SettingKey rung_of(SettingKey key);                        // the same for all settings of the grid, and for no other rung
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
std::vector<PointSetting> point_settings(const Scene& scene, const SettingRange& range);

// One setting of each deformer of the user's own.
std::vector<PointSetting> external_settings(const std::vector<DeformerSpec>& external);

// A digest in 32 hexadecimal digits of everything that the points depend on: their options and meshes.
std::string digest_of(const std::vector<PointSetting>& settings);

}  // namespace experiments

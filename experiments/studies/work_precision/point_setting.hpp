// The points of a work-precision diagram: each deformer at many settings.
//   for (const PointSetting& setting : point_settings(scene, {.coarser_vertices = {600}})) ...
// LBS and DQS have no settings. Delta mush has iterations of smoothing. PBS has iterations, k_stretch, order and precision, Mueller's
// exponent and substeps (outside a jiggling zone each substep begins at LBS anew, so that only the last one counts). XPBD with the
// reference's material has iterations, and small steps at equal cost. Finite elements have laws, element orders and sizes of mesh. LBS and
// PBS also run on coarser and finer meshes of the body.
#pragma once

#include "analysis/records/typed_table.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/scene/scene.hpp"
#include "pbs/solver/options.hpp"

#include <optional>
#include <string>
#include <vector>

namespace experiments {

struct PointSetting {
    std::string deformer;  // its front: lbs, dqs, delta_mush, pbs, pbs_exponent, xpbd, xpbd_small_steps, fem_linear, ...
    DeformerSpec spec;
    int substeps = 1;      // steps per frame
    int vertices = 0;      // wanted size of another mesh of the body; 0: the case's own
    bool refined = false;  // on the case's own tets, each cut into eight

    bool on_own_mesh() const { return vertices == 0 && !refined; }

    bool is_newton() const
    {
        const FemOptions* fem = options_if<FemOptions>(spec);
        return fem && fem->model != reference_fem::Model::linear;
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
    bool operator==(const SettingKey&) const = default;
};
SettingKey key_of(const PointSetting& setting);
const analysis::Columns<SettingKey>& setting_columns();  // all fields except the deformer

std::string text_of(const SettingKey& key);  // as it is recorded: pbs, iterations 24, k_stretch 0.2, order ordered, precision f32, ...

struct SettingRange {
    bool quadratic = true;                   // neo-Hookean flesh on quadratic elements too
    bool quadratic_corotational = true;      // corotational too
    std::vector<int> coarser_vertices = {};  // sizes of other meshes of the body
    std::vector<int> finer_vertices = {};
    int quadratic_up_to = 1000;  // sizes of other meshes on which the nonlinear laws have quadratic elements too
    bool refined = false;        // neo-Hookean flesh on the case's own tets, each cut into eight
};
nlohmann::json to_json(const SettingRange& range);

// The scene gives the options that are not varied: its pbs, and the material of its first [[fem]].
std::vector<PointSetting> point_settings(const Scene& scene, const SettingRange& range);

// A digest in 32 hexadecimal digits of everything that the points depend on: their options, substeps and meshes.
std::string digest_of(const std::vector<PointSetting>& settings);

}  // namespace experiments

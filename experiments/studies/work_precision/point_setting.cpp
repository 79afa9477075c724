#include "experiments/studies/work_precision/point_setting.hpp"

#include "experiments/deformers/deformer_options.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/settings/recorded_settings.hpp"
#include "experiments/studies/shared/posed_reference.hpp"
#include "pbs/character/body_cache.hpp"
#include "pbs/solver/options.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace experiments {
namespace {

constexpr std::size_t grid_in_short = 3;

// Finite elements with the reference's material and attachment.
DeformerSpec fem_spec(const Scene& scene, reference_fem::Model model, int element_order)
{
    DeformerSpec spec = reference_flesh(scene);
    spec.name = spec.label = fmt::format("{}_p{}", name_of(model), element_order);
    auto& options = options_of<FemOptions>(spec);
    options.model = model;
    options.element_order = element_order;
    options.nested_start = element_order == 2 && model != reference_fem::Model::linear;
    return spec;
}

class SettingList {
public:
    SettingList(const Scene& scene, const SettingRange& range) : scene_(scene), range_(range) {}

    // All settings at all rungs of the case's own mesh, and the default setting at some rungs of the other meshes.
    void add(const ComparedDeformer& entry)
    {
        const std::vector<SettingChange> grid = grid_in_range(entry);
        for (const KeyValues& code : codes_of(entry)) {
            for (const SettingChange& change : grid)
                add_ladder(entry, range_.in_short ? entry.few_iterations : entry.iterations, {{}, change, code}, 0);
            for (const std::vector<int>* sizes : {&range_.other_vertices, &range_.without_fem})
                for (const int vertices : *sizes) add_ladder(entry, entry.few_iterations, {{}, grid.front(), code}, vertices);
        }
    }

    // A change to PBS, on the case's own mesh in its packed code alone.
    void add_change(const ComparedDeformer& entry)
    {
        const std::size_t first = settings.size();
        for (const SettingChange& change : grid_in_range(entry))
            add_ladder(entry, range_.in_short ? entry.few_iterations : entry.iterations, {{}, change, codes_of(entry).front()}, 0);
        for (std::size_t i = first; i < settings.size(); ++i) settings[i].change = &entry;
    }

    void add_fem()
    {
        using reference_fem::Model;
        for (const Model model : {Model::linear, Model::corotational, Model::neo_hookean})
            for (const int element_order : {1, 2})
                if (element_order == 1 || (range_.quadratic && model != Model::corotational)) add_fem(model, element_order, 0);
        add_fem(Model::stable_neo_hookean, 1, 0);  // the limit of the deformers that minimise an energy
        for (const int vertices : range_.other_vertices)
            for (const Model model : {Model::linear, Model::neo_hookean})
                for (const int element_order : {1, 2})
                    if (element_order == 1 || (range_.quadratic && model == Model::neo_hookean && vertices <= range_.quadratic_up_to))
                        add_fem(model, element_order, vertices);
        if (!range_.refined) return;
        PointSetting setting{"fem_neo_hookean", fem_spec(scene_, Model::neo_hookean, 1)};
        setting.refined = options_of<FemOptions>(setting.spec).nested_start = true;
        settings.push_back(setting);
    }

    std::vector<PointSetting> settings;

private:
    std::vector<SettingChange> grid_in_range(const ComparedDeformer& entry) const
    {
        std::vector<SettingChange> grid = grid_of(entry);
        if (range_.in_short) grid.resize(std::min(grid.size(), grid_in_short));
        return grid;
    }

    void add_ladder(const ComparedDeformer& entry, const std::vector<int>& iterations, SettingChoice choice, int vertices)
    {
        std::vector<std::optional<int>> rungs(iterations.begin(), iterations.end());
        if (rungs.empty()) rungs.emplace_back();
        for (const std::optional<int> rung : rungs) {
            choice.iterations = rung;
            settings.push_back({entry.name, spec_with(entry, scene_, choice), rung, name_of(choice.change), vertices});
        }
    }

    void add_fem(reference_fem::Model model, int element_order, int vertices)
    {
        PointSetting setting{"fem_" + name_of(model), fem_spec(scene_, model, element_order)};
        setting.vertices = vertices;
        settings.push_back(setting);
    }

    const Scene& scene_;
    const SettingRange& range_;
};

}  // namespace

SettingKey key_of(const PointSetting& setting)
{
    const DeformerSpec& spec = setting.spec;
    const DeformerTraits traits = traits_of(spec);
    SettingKey key{.deformer = setting.deformer, .iterations = setting.iterations, .precision = traits.precision};
    if (setting.vertices > 0) key.wanted_vertices = setting.vertices;
    key.refined = setting.refined;
    key.tuned = setting.tuned;
    key.packed = traits.packed;
    if (setting.is_external()) key.precision.clear();  // it is not known
    if (const auto* xpbd = options_if<pbs::XpbdOptions>(spec)) key.iterations = xpbd->iterations, key.substeps = xpbd->substeps;
    if (const auto* fem = options_if<FemOptions>(spec)) key.element_order = fem->element_order;
    const auto* pbs = options_if<pbs::PbsOptions>(spec);
    if (!pbs) return key;
    key.k_stretch = pbs->k_stretch;
    key.order = name_of(pbs->order);
    key.substeps = 1;
    return key;
}

SettingKey rung_of(SettingKey key)
{
    key.k_stretch.reset();
    key.tuned.clear();
    return key;
}

const analysis::Columns<SettingKey>& setting_columns()
{
    static const analysis::Columns<SettingKey> columns =
        analysis::Columns<SettingKey>{
            {"iterations", &SettingKey::iterations, "", "iterations per step"},
            {"k_stretch", &SettingKey::k_stretch, "", "PBS: stiffness of the stretch constraints"},
            {"order", &SettingKey::order, "", "PBS: order of projection"},
            {"precision", &SettingKey::precision, "", "f32 or f64"},
            {"substeps", &SettingKey::substeps, "", "PBS and XPBD: substeps per frame"},
            {"element_order", &SettingKey::element_order, "", "finite elements: 1 linear, 2 quadratic"},
            {"wanted_vertices", &SettingKey::wanted_vertices, "", "wanted size of another mesh of the body; empty on the case's own"},
            {"refined", &SettingKey::refined, "", "solved on the case's own tets, each cut into eight"}} +
        analysis::Columns<SettingKey>{
            {"tuned", &SettingKey::tuned, "", "the setting of the deformer's grid, as an identifier; empty: the default one"},
            {"packed", &SettingKey::packed, "", "code that computes several constraints, vertices or tets per instruction"}}
            .in_group("code");
    return columns;
}

const analysis::Columns<SettingKey>& point_key_columns()
{
    static const analysis::Columns<SettingKey> columns =
        analysis::Columns<SettingKey>{{"deformer", &SettingKey::deformer, "", "name of the deformer"}} + setting_columns();
    return columns;
}

std::string digest_of(const std::vector<PointSetting>& settings)
{
    nlohmann::json all = nlohmann::json::array();
    for (const PointSetting& setting : settings)
        all.push_back({setting.deformer, to_json(setting.spec), setting.tuned, setting.vertices, setting.refined});
    return pbs::content_hash(all.dump());
}

RECORD_SETTINGS(SettingRange, in_short, quadratic, other_vertices, without_fem, quadratic_up_to, refined, changes)

std::vector<PointSetting> external_settings(const std::vector<DeformerSpec>& external)
{
    std::vector<PointSetting> settings;
    for (const DeformerSpec& spec : external) settings.push_back({spec.name, spec});
    return settings;
}

std::vector<PointSetting> point_settings(const Scene& scene, const SettingRange& range)
{
    SettingList list(scene, range);
    for (const ComparedDeformer& entry : compared_deformers())
        if (is_available(entry)) list.add(entry);
    list.add_fem();
    if (range.changes)
        for (const ComparedDeformer& entry : changes_to_pbs()) list.add_change(entry);
    return list.settings;
}

}  // namespace experiments

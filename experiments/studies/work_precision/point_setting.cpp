#include "experiments/studies/work_precision/point_setting.hpp"

#include "experiments/deformers/fem/fem_option_names.hpp"
#include "experiments/deformers/pbs/pbs_option_names.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/settings/option_fields.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "experiments/studies/shared/posed_reference.hpp"
#include "pbs/character/body_cache.hpp"
#include "pbs/skinning/delta_mush.hpp"
#include "pbs/solver/xpbd_options.hpp"

#include <fmt/format.h>

namespace experiments {
namespace {

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
    explicit SettingList(const Scene& scene) : scene_(scene), base_(spec_of(scene, "pbs"))
    {
        options_of<pbs::PbsOptions>(base_).jiggle.reset();
        base_.threads = 1;
    }

    void add_geometric()
    {
        for (const char* kind : {"lbs", "dqs"}) add({.deformer = kind, .spec = default_spec(kind)});
        for (const int iterations : {0, 1, 2, 5, 10, 20, 50, 100, 200}) {
            PointSetting setting{"delta_mush", default_spec("delta_mush")};
            options_of<pbs::DeltaMushOptions>(setting.spec).iterations = iterations;
            add(setting);
        }
    }

    void add_pbs()
    {
        for (const double k_stretch : {0.05, 0.2, 0.5, 0.9})
            for (const int iterations : {1, 2, 4, 8, 24, 48, 96, 192, 384}) add_pbs(pbs_with(iterations, k_stretch));
        for (const pbs::Order order : {pbs::Order::plain, pbs::Order::ordered, pbs::Order::grouped})
            for (const pbs::Precision precision : {pbs::Precision::f32, pbs::Precision::f64}) {
                pbs::PbsOptions options = pbs_with(24, own_pbs().k_stretch);
                options.order = order;
                options.precision = precision;
                if (order != own_pbs().order || precision != own_pbs().precision) add_pbs(options);
            }
        for (const int substeps : {2, 4}) add_pbs(pbs_with(24, own_pbs().k_stretch), substeps);
    }

    void add_pbs_with_exponent()
    {
        for (const double k_stretch : {0.2, 0.9})
            for (const int iterations : {1, 4, 24, 96, 384}) {
                pbs::PbsOptions options = pbs_with(iterations, k_stretch);
                options.stiffness_form = pbs::StiffnessForm::exponent;
                add_pbs(options);
            }
    }

    void add_xpbd()
    {
        for (const int count : {1, 2, 4, 8, 16, 24, 48, 96, 384}) {
            PointSetting setting{"xpbd", default_spec("xpbd")};
            const DeformerSpec reference = reference_flesh(scene_);
            const auto& flesh = options_of<FemOptions>(reference);
            pbs::XpbdOptions options = {.young_pa = flesh.young_pa, .poisson = flesh.poisson, .iterations = count};
            setting.spec.options = options;
            add(setting);
            setting.deformer = "xpbd_small_steps";
            options.iterations = 1;
            options.substeps = count;
            setting.spec.options = options;
            if (count > 1) add(setting);
        }
    }

    void add_fem(const SettingRange& range)
    {
        using reference_fem::Model;
        for (const Model model : {Model::linear, Model::corotational, Model::neo_hookean})
            for (const int element_order : {1, 2}) {
                const DeformerSpec spec = fem_spec(scene_, model, element_order);
                const PointSetting setting{"fem_" + name_of(model), spec};
                const bool quadratic = model == Model::corotational ? range.quadratic_corotational : range.quadratic;
                if (element_order == 1 || model == Model::linear || quadratic) add(setting);
            }
        if (!range.refined) return;
        PointSetting setting{"fem_neo_hookean", fem_spec(scene_, Model::neo_hookean, 1)};
        setting.refined = options_of<FemOptions>(setting.spec).nested_start = true;
        add(setting);
    }

    void add_other_mesh(int vertices, int quadratic_up_to)
    {
        const auto elsewhere = [&](PointSetting setting) {
            setting.vertices = vertices;
            add(setting);
        };
        elsewhere({"lbs", default_spec("lbs")});
        for (const int iterations : {4, 24, 96}) {
            DeformerSpec spec = base_;
            spec.options = pbs_with(iterations, own_pbs().k_stretch);
            elsewhere({"pbs", spec});
        }
        using reference_fem::Model;
        for (const Model model : {Model::linear, Model::corotational, Model::neo_hookean})
            for (const int element_order : {1, 2})
                if (element_order == 1 || model == Model::linear || vertices <= quadratic_up_to)
                    elsewhere({"fem_" + name_of(model), fem_spec(scene_, model, element_order)});
    }

    std::vector<PointSetting> settings;

private:
    void add(const PointSetting& setting) { settings.push_back(setting); }

    void add_pbs(const pbs::PbsOptions& options, int substeps = 1)
    {
        const bool has_exponent = options.stiffness_form == pbs::StiffnessForm::exponent;
        PointSetting setting{has_exponent ? "pbs_exponent" : "pbs", base_, substeps};
        setting.spec.options = options;
        add(setting);
    }

    const pbs::PbsOptions& own_pbs() const { return options_of<pbs::PbsOptions>(base_); }

    pbs::PbsOptions pbs_with(int iterations, double k_stretch) const
    {
        pbs::PbsOptions options = own_pbs();
        options.iterations = iterations;
        options.k_stretch = k_stretch;
        return options;
    }

    const Scene& scene_;
    DeformerSpec base_;
};

}  // namespace

SettingKey key_of(const PointSetting& setting)
{
    const DeformerSpec& spec = setting.spec;
    SettingKey key{setting.deformer};
    if (setting.vertices > 0) key.wanted_vertices = setting.vertices;
    key.refined = setting.refined;
    if (const auto* mush = options_if<pbs::DeltaMushOptions>(spec)) key.iterations = mush->iterations;
    if (const auto* xpbd = options_if<pbs::XpbdOptions>(spec)) key.iterations = xpbd->iterations, key.substeps = xpbd->substeps;
    if (const auto* fem = options_if<FemOptions>(spec)) key.element_order = fem->element_order;
    const auto* pbs = options_if<pbs::PbsOptions>(spec);
    if (!pbs) return key;
    key.iterations = pbs->iterations;
    key.k_stretch = pbs->k_stretch;
    key.order = name_of(pbs->order);
    key.precision = name_of(pbs->precision);
    key.substeps = setting.substeps;
    return key;
}

const analysis::Columns<SettingKey>& setting_columns()
{
    static const analysis::Columns<SettingKey> columns = {
        {"iterations", &SettingKey::iterations, "", "iterations per step"},
        {"k_stretch", &SettingKey::k_stretch, "", "PBS: stiffness of the stretch constraints"},
        {"order", &SettingKey::order, "", "PBS: order of projection"},
        {"precision", &SettingKey::precision, "", "PBS: f32 or f64"},
        {"substeps", &SettingKey::substeps, "", "PBS and XPBD: substeps per frame"},
        {"element_order", &SettingKey::element_order, "", "finite elements: 1 linear, 2 quadratic"},
        {"wanted_vertices", &SettingKey::wanted_vertices, "", "wanted size of another mesh of the body; empty on the case's own"},
        {"refined", &SettingKey::refined, "", "solved on the case's own tets, each cut into eight"}};
    return columns;
}

std::string text_of(const SettingKey& key)
{
    std::string text = key.deformer;
    const analysis::CsvTable cells = table_of(setting_columns(), {key});
    for (const std::string& column : cells.columns())
        if (const std::string& value = cells.text_at(0, column); !value.empty() && column != "refined")
            text += fmt::format(", {} {}", column, value);
    return text + (key.refined ? ", refined" : "");
}

std::string digest_of(const std::vector<PointSetting>& settings)
{
    nlohmann::json all = nlohmann::json::array();
    for (const PointSetting& setting : settings)
        all.push_back({setting.deformer, to_json(setting.spec), setting.substeps, setting.vertices, setting.refined});
    return pbs::content_hash(all.dump());
}

nlohmann::json to_json(const SettingRange& range)
{
    static const auto fields = OptionFields<SettingRange>("range")
                                   .record("quadratic", &SettingRange::quadratic)
                                   .record("quadratic_corotational", &SettingRange::quadratic_corotational)
                                   .record("coarser_vertices", &SettingRange::coarser_vertices)
                                   .record("finer_vertices", &SettingRange::finer_vertices)
                                   .record("quadratic_up_to", &SettingRange::quadratic_up_to)
                                   .record("refined", &SettingRange::refined)
                                   .complete();
    return fields.json(range);
}

std::vector<PointSetting> point_settings(const Scene& scene, const SettingRange& range)
{
    SettingList list(scene);
    list.add_geometric();
    list.add_pbs();
    list.add_pbs_with_exponent();
    list.add_xpbd();
    list.add_fem(range);
    for (const int vertices : range.coarser_vertices) list.add_other_mesh(vertices, range.quadratic_up_to);
    for (const int vertices : range.finer_vertices) list.add_other_mesh(vertices, range.quadratic_up_to);
    return list.settings;
}

}  // namespace experiments

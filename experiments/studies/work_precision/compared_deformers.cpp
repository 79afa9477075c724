#include "experiments/studies/work_precision/compared_deformers.hpp"

#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/scene/scene_keys.hpp"
#include "experiments/settings/scene_values.hpp"
#include "experiments/studies/shared/posed_reference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace experiments {
namespace {

const std::vector<int> of_projections = {1, 2, 4, 8, 16, 24, 48, 96, 192}, few_of_projections = {4, 24, 96};
const std::vector<int> of_minimisers = {1, 2, 4, 8, 12, 16, 24, 48, 96}, few_of_minimisers = {4, 12, 24};
const std::vector<SettingChange> of_stiffness = {{}, {.stiffness_factor = 4.0}, {.stiffness_factor = 16.0}};

KeyValues set(const std::string& kind, const std::string& key, const std::string& value)
{
    return {kind + "." + key + "=" + value};
}

std::vector<SettingChange> each_of(const std::string& key, const std::vector<std::string>& values)
{
    std::vector<SettingChange> grid = {{}};
    for (const std::string& value : values) grid.push_back({{key + "=" + value}});
    return grid;
}

std::vector<ComparedDeformer> geometric()
{
    std::vector<ComparedDeformer> entries;
    for (const auto& [kind, words] : {std::pair{"lbs", "LBS"}, {"dqs", "DQS"}})
        for (const char* weights : {"", "smooth"}) {
            const std::string suffix = *weights ? "_smooth" : "";
            entries.push_back({.name = kind + suffix,
                               .kind = kind,
                               .group = kind + suffix,
                               .words = std::string(words) + (*weights ? " with smooth weights" : ""),
                               .weights = weights});
        }
    entries.push_back({.name = "delta_mush",
                       .kind = "delta_mush",
                       .group = "delta_mush",
                       .words = "delta mush",
                       .iterations_key = "delta_mush.iterations",
                       .iterations = {0, 1, 2, 5, 10, 20, 50, 100, 200},
                       .few_iterations = {2, 10, 50},
                       .grid = each_of("delta_mush.step", {"0.25", "0.9"})});
    entries.push_back(
        {.name = "direct_delta_mush", .kind = "direct_delta_mush", .group = "direct_delta_mush", .words = "direct delta mush"});
    return entries;
}

std::vector<ComparedDeformer> projecting()
{
    const std::string exponent = "pbs.variant.stiffness=exponent";
    std::vector<ComparedDeformer> entries;
    entries.push_back({.name = "pbs",
                       .kind = "pbs",
                       .group = "pbs",
                       .words = "PBS",
                       .iterations_key = "pbs.iterations",
                       .iterations = of_projections,
                       .few_iterations = few_of_projections,
                       .grid = {{},
                                {{"pbs.k_stretch=0.5"}},
                                {{"pbs.k_stretch=0.9"}},
                                {{"pbs.k_stretch=0.05"}},
                                {{exponent}},
                                {{"pbs.k_stretch=0.9", exponent}}},
                       .codes = {{"pbs.order=ordered", "pbs.precision=f32"}, {"pbs.order=plain", "pbs.precision=f64"}},
                       .stiffness_key = "pbs.k_stretch",
                       .highest_stiffness = 1.0});
    entries.push_back({.name = "pbs_author",
                       .kind = "pbs_author",
                       .group = "pbs_author",
                       .words = "the first author's later code",
                       .iterations_key = "pbs_author.iterations",
                       .iterations = of_projections,
                       .few_iterations = few_of_projections});
    for (const auto& [kind, words] : {std::pair{"xpbd", "XPBD"}, {"xpbd_small_steps", "XPBD"}})
        entries.push_back({.name = kind,
                           .kind = kind,
                           .group = "xpbd",
                           .words = words,
                           .iterations_key = "pbs.iterations",
                           .iterations = of_projections,
                           .few_iterations = few_of_projections,
                           .grid = of_stiffness,
                           .young_key = "xpbd.young_pa",
                           .poisson_key = "xpbd.poisson",
                           .stiffness_key = "xpbd.young_pa"});
    return entries;
}

// Deformers with the reference's material, held by the reference's springs.
ComparedDeformer elastic(const std::string& kind, const std::string& words)
{
    return {.name = kind,
            .kind = kind,
            .group = kind,
            .words = words,
            .iterations_key = kind + ".iterations",
            .iterations = of_minimisers,
            .few_iterations = few_of_minimisers,
            .codes = {set(kind, "arithmetic", "packed_f32"), set(kind, "arithmetic", "plain_f64")},
            .poisson_key = kind + ".poisson"};
}

std::vector<ComparedDeformer> elastic_ones()
{
    return {elastic("quasi_newton", "quasi-Newton"), elastic("vbd", "vertex block descent"),
            elastic("xpbd_neo_hookean", "neo-Hookean XPBD"), elastic("projective_dynamics", "projective dynamics")};
}

const std::string& text_of_scene(const Scene& scene)
{
    for (const BuiltInScene& built_in : built_in_scenes())
        if (built_in.name == scene.name) return built_in.text;
    throw std::logic_error("deformers are compared in built-in scenes, not in " + scene.name);
}

std::string assigned(const std::string& key, double value)
{
    return fmt::format("{}={:.17g}", key, value);
}

SceneValues values_with(const ComparedDeformer& entry, const Scene& scene, const KeyValues& keys)
{
    std::string text = text_of_scene(scene);
    if (!entry.weights.empty()) text += fmt::format("\n[[{}]]\nname = \"{}\"\nweights = \"{}\"\n", entry.kind, entry.name, entry.weights);
    return SceneValues(text, scene.file, keys, scene_schema());
}

}  // namespace

const std::vector<ComparedDeformer>& compared_deformers()
{
    static const std::vector<ComparedDeformer> entries = [] {
        std::vector<ComparedDeformer> all = geometric();
        for (const auto& more : {projecting(), elastic_ones()}) all.insert(all.end(), more.begin(), more.end());
        return all;
    }();
    return entries;
}

bool is_registered(const ComparedDeformer& entry)
{
    return find_deformer_kind(entry.kind) != nullptr;
}

double stiffness_of(const ComparedDeformer& entry, const Scene& scene)
{
    const DeformerSpec flesh = reference_flesh(scene);
    if (entry.stiffness_key == entry.young_key) return options_of<FemOptions>(flesh).young_pa;
    return values_with(entry, scene, entry.fixed).number(entry.stiffness_key);
}

DeformerSpec spec_with(const ComparedDeformer& entry, const Scene& scene, const SettingChoice& choice)
{
    const DeformerSpec reference = reference_flesh(scene);
    const auto& flesh = options_of<FemOptions>(reference);
    KeyValues keys = entry.fixed;
    for (const KeyValues& more : {choice.code, choice.change.keys}) keys.insert(keys.end(), more.begin(), more.end());
    if (choice.iterations) keys.push_back(fmt::format("{}={}", entry.iterations_key, *choice.iterations));
    if (!entry.young_key.empty()) keys.push_back(assigned(entry.young_key, flesh.young_pa));
    if (!entry.poisson_key.empty()) keys.push_back(assigned(entry.poisson_key, flesh.poisson));
    if (const double factor = choice.stiffness_factor * choice.change.stiffness_factor; factor != 1.0)
        keys.push_back(assigned(entry.stiffness_key, std::min(factor * stiffness_of(entry, scene), entry.highest_stiffness)));
    const SceneValues values = values_with(entry, scene, keys);
    DeformerSpec spec = default_spec(entry.kind);
    spec.name = spec.label = entry.name;
    const std::string table = entry.weights.empty() ? entry.kind : fmt::format("{}.{}", entry.kind, values.tables(entry.kind) - 1);
    const DeformerKind& kind = *find_deformer_kind(entry.kind);
    if (kind.read) kind.read(values, table, spec);
    spec.threads = 1;
    return spec;
}

std::string name_of(const SettingChange& change)
{
    std::string name;
    const auto add = [&](const std::string& part) { name += (name.empty() ? "" : "+") + part; };
    for (std::string key : change.keys) {
        const std::size_t equals = key.find('='), dot = key.rfind('.', equals);
        key[equals] = '_';
        add(key.substr(dot + 1));
    }
    if (change.stiffness_factor != 1.0) add(fmt::format("stiffness_factor_{:g}", change.stiffness_factor));
    return name;
}

}  // namespace experiments

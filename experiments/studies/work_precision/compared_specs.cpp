// From an entry of the table of compared deformers to a deformer with its options.
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/settings/scene_values.hpp"
#include "experiments/studies/shared/posed_reference.hpp"
#include "experiments/studies/work_precision/compared_deformers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace experiments {
namespace {

const std::string& text_of_scene(const Scene& scene)
{
    for (const BuiltInScene& built_in : built_in_scenes())
        if (built_in.name == scene.name) return built_in.text;
    throw std::logic_error("deformers are compared in built-in scenes, not in " + scene.name);
}

bool exist(const KeyValues& keys)
{
    const SceneSchema schema = scene_schema();
    return std::ranges::all_of(keys, [&](const std::string& key) { return schema.find(key.substr(0, key.find('='))) != nullptr; });
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

bool is_available(const ComparedDeformer& entry)
{
    KeyValues keys = entry.fixed;
    if (!entry.iterations_key.empty()) keys.push_back(entry.iterations_key);
    return find_deformer_kind(entry.kind) && exist(keys);
}

std::vector<SettingChange> grid_of(const ComparedDeformer& entry)
{
    std::vector<SettingChange> grid = entry.grid;
    std::erase_if(grid, [](const SettingChange& change) { return !exist(change.keys); });
    return grid;
}

std::vector<KeyValues> codes_of(const ComparedDeformer& entry)
{
    std::vector<KeyValues> codes = entry.codes;
    std::erase_if(codes, [](const KeyValues& code) { return !exist(code); });
    return codes.empty() ? std::vector<KeyValues>{{}} : codes;
}

DeformerSpec spec_with(const ComparedDeformer& entry, const Scene& scene, const SettingChoice& choice)
{
    const DeformerSpec reference = reference_flesh(scene);
    const auto& flesh = options_of<FemOptions>(reference);
    KeyValues keys = entry.fixed;
    for (const KeyValues& more : {choice.code, choice.change.keys}) keys.insert(keys.end(), more.begin(), more.end());
    if (choice.iterations) keys.push_back(fmt::format("{}={}", entry.iterations_key, *choice.iterations));
    if (!entry.young_key.empty()) keys.push_back(assigned(entry.young_key, choice.change.young_factor * flesh.young_pa));
    if (!entry.poisson_key.empty()) keys.push_back(assigned(entry.poisson_key, flesh.poisson));
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
    if (change.young_factor != 1.0) add(fmt::format("stiffness_factor_{:g}", change.young_factor));
    return name;
}

}  // namespace experiments

#include "experiments/studies/stability/deformer_option.hpp"

#include "experiments/deformers/registry.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/settings/scene_values.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace experiments {

bool has_option(const std::string& kind, const std::string& key)
{
    const std::vector<SceneKey>& keys = find_deformer_kind(kind)->keys;
    return std::any_of(keys.begin(), keys.end(), [&](const SceneKey& one) { return one.table == kind && one.name == key; });
}

// The numbers, texts and truth values of JSON are spelled as in TOML.
DeformerSpec with_option(const DeformerSpec& spec, const std::string& key, const nlohmann::json& value)
{
    const DeformerKind& kind = *find_deformer_kind(spec.kind);
    nlohmann::json options = kind.options_json(spec);
    options[key] = value;
    std::vector<std::string> overrides;
    for (const auto& [name, setting] : options.items()) overrides.push_back(spec.kind + "." + name + "=" + setting.dump());
    DeformerSpec changed = spec;
    kind.read(SceneValues("schema = 1\n", "stability", overrides, scene_schema()), spec.kind, changed);
    return changed;
}

}  // namespace experiments

#include "experiments/settings/scene_values.hpp"

#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <set>

namespace experiments {
namespace {

// The keys and tables of a table; "" is the top level.
std::vector<std::string> known_names(const std::vector<SceneKey>& keys, const std::string& table)
{
    std::set<std::string> names;
    for (const SceneKey& key : keys) {
        if (key.table == table) names.insert(key.name);
        if (table.empty() && !key.table.empty()) names.insert(key.table.substr(0, key.table.find('.')));
        if (key.table.size() > table.size() && key.table.starts_with(table + ".")) names.insert(key.table.substr(table.size() + 1));
    }
    return {names.begin(), names.end()};
}

}  // namespace

std::string default_text(const nlohmann::json& value)
{
    if (!value.is_array()) return value.dump();
    std::vector<std::string> elements;
    for (const auto& element : value) elements.push_back(element.dump());
    return fmt::format("[{}]", fmt::join(elements, ", "));
}

std::string SceneKey::rule() const
{
    if (!choices.empty()) {
        std::vector<std::string> shown;
        for (const auto& choice : choices) shown.push_back(choice.empty() ? "\"\"" : choice);
        return fmt::format("expected one of {}", fmt::join(shown, ", "));
    }
    static constexpr const char* names[] = {"a text",        "a number",          "an integer",      "true or false",
                                            "three numbers", "a list of numbers", "a list of texts", "a list of integers"};
    std::string words = fmt::format("expected {}", names[static_cast<int>(type)]);
    if (lowest == above_zero)
        words += highest < infinite ? fmt::format(" > 0 and <= {:.10g}", highest) : " > 0";
    else if (lowest > -infinite && highest < infinite)
        words += fmt::format(" from {:.10g} to {:.10g}", lowest, highest);
    else if (lowest > -infinite)
        words += fmt::format(" >= {:g}", lowest);
    return words;
}

const SceneKey* SceneSchema::find(const std::string& path) const
{
    const auto found = std::find_if(keys.begin(), keys.end(), [&](const SceneKey& key) { return key.path() == path; });
    return found == keys.end() ? nullptr : &*found;
}

bool SceneSchema::is_table(const std::string& path) const
{
    return std::any_of(keys.begin(), keys.end(),
                       [&](const SceneKey& key) { return key.table == path || key.table.starts_with(path + "."); });
}

bool SceneSchema::is_list(const std::string& table) const
{
    return std::any_of(keys.begin(), keys.end(), [&](const SceneKey& key) { return key.in_list && key.table == table; });
}

// Searched in the table of the path, or in the nearest known table that contains it.
std::string SceneSchema::nearest_key(const std::string& path) const
{
    const auto dot = path.rfind('.');
    if (dot == std::string::npos) return pbs::nearest_name(path, known_names(keys, ""));
    const std::string table = path.substr(0, dot);
    const std::vector<std::string> known = known_names(keys, table);
    return known.empty() ? nearest_key(table) : table + "." + pbs::nearest_name(path.substr(dot + 1), known);
}

}  // namespace experiments

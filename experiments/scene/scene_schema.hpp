// The one table of scene keys: it validates, documents (`pbskin explain KEY`) and holds the defaults.
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace experiments {

enum class KeyType { text, number, integer, boolean, vec3, numbers, texts, integers };

struct SceneKey {
    std::string table;  // "pbs", "motion", ...; "" for the top level; "fem" is an array of tables
    std::string name;
    KeyType type = KeyType::number;
    std::string default_json;  // JSON text; "" where there is no default
    std::string unit;
    double lowest = -std::numeric_limits<double>::infinity();
    double highest = std::numeric_limits<double>::infinity();
    std::vector<std::string> choices;  // of a text
    std::string meaning;

    std::string path() const { return table.empty() ? name : table + "." + name; }
    std::string rule() const;  // what a value must be, in words
};

const std::vector<SceneKey>& scene_keys();
const SceneKey* find_scene_key(const std::string& path);  // "pbs.k_volume"; null where there is none

}  // namespace experiments

// The keys of a scene. They check it, document it (`pbskin explain KEY`) and hold the defaults. The list of all keys is scene_schema() in
// experiments/scene/scene_keys.hpp.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <limits>
#include <string>
#include <vector>

namespace experiments {

enum class KeyType { text, number, integer, boolean, vec3, numbers, texts, integers };

inline constexpr double infinite = std::numeric_limits<double>::infinity();
inline constexpr double above_zero = std::numeric_limits<double>::min();  // as the lowest value, it allows all numbers > 0

// A default value as a scene writes it, e.g. [0.0, 0.0].
std::string default_text(const nlohmann::json& value);

struct SceneKey {
    std::string table;  // "pbs", "motion", ...; "" for the top level; a table within a table has defaults only if the scene has it
    std::string name;
    KeyType type = KeyType::number;
    std::string default_json = {};  // JSON text; "": there is no default
    std::string unit = {};
    double lowest = -infinite;
    double highest = infinite;
    std::vector<std::string> choices = {};  // of a text
    std::string meaning = {};
    bool in_list = false;  // the table is an array of tables: [[fem]]

    std::string path() const { return table.empty() ? name : table + "." + name; }
    std::string rule() const;  // what a value must be: "expected a number from 0 to 1"
};

struct SceneSchema {
    std::vector<SceneKey> keys;

    const SceneKey* find(const std::string& path) const;  // e.g. "pbs.k_volume"; null: there is no such key
    bool is_table(const std::string& path) const;         // a table that has keys or tables
    bool is_list(const std::string& table) const;         // an array of tables
    std::string nearest_key(const std::string& path) const;
};

}  // namespace experiments

// Keys of a scene: they validate, document (`pbskin explain KEY`) and hold the defaults. The list of all keys is scene_schema() in
// experiments/scene/scene_keys.hpp.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <limits>
#include <string>
#include <vector>

namespace experiments {

enum class KeyType { text, number, integer, boolean, vec3, numbers, texts, integers };

inline constexpr double infinite = std::numeric_limits<double>::infinity();
inline constexpr double above_zero = std::numeric_limits<double>::min();  // as a lowest value: all numbers > 0

// A default as a scene would write it: [0.0, 0.0].
std::string default_text(const nlohmann::json& value);

struct SceneKey {
    std::string table;  // "pbs", "motion", ...; "" for the top level; the defaults of a table in a table hold only where a scene has it
    std::string name;
    KeyType type = KeyType::number;
    std::string default_json = {};  // JSON text; "" where there is no default
    std::string unit = {};
    double lowest = -infinite;
    double highest = infinite;
    std::vector<std::string> choices = {};  // of a text
    std::string meaning = {};
    bool in_list = false;  // the table is an array of tables: [[fem]]

    std::string path() const { return table.empty() ? name : table + "." + name; }
    std::string rule() const;  // what a value must be, in words
};

struct SceneSchema {
    std::vector<SceneKey> keys;

    const SceneKey* find(const std::string& path) const;  // "pbs.k_volume"; null where there is none
    bool is_table(const std::string& path) const;         // of keys, or of such tables
    bool is_list(const std::string& table) const;         // an array of tables
    std::string nearest_key(const std::string& path) const;
};

}  // namespace experiments

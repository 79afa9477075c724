// A scene as checked values: every key of the schema with its value from the file, from --set or by default, and its
// place in the text.
#pragma once

#include <nlohmann/json.hpp>

#include <limits>
#include <map>
#include <string>
#include <vector>

namespace experiments {

// The keys of a scene. They check it, document it (`pbskin explain KEY`) and hold the defaults. The list of all keys is
// scene_schema() in experiments/scene/scene.hpp.
enum class KeyType { text, number, integer, boolean, vec3, numbers, texts, integers };

inline constexpr double infinite = std::numeric_limits<double>::infinity();
// as the lowest value, it allows all numbers > 0
inline constexpr double above_zero = std::numeric_limits<double>::min();

// A default value as a scene writes it, e.g. [0.0, 0.0].
std::string default_text(const nlohmann::json& value);

struct Range {
    double lowest = -infinite, highest = infinite;
};

struct SceneKey {
    std::string table;  // "pbs", "motion", ...; "" for the top level; a table within a table has defaults only if the
                        // scene has it
    std::string name;
    KeyType type = KeyType::number;
    std::string default_json = {};  // JSON text; "": there is no default
    std::string unit = {};
    Range range = {};                       // of a number, or of each in a list
    std::vector<std::string> choices = {};  // of a text
    std::string meaning = {};
    bool in_list = false;  // the table is an array of tables: [[fem]]

    std::string path() const { return table.empty() ? name : table + "." + name; }
    std::string rule() const;  // what a value must be: "expected a number from 0 to 1"
};

// A key of an earlier release, which a scene may still have: it is read with a warning that names the keys in its
// place.
struct RenamedKey {
    std::string path;                                     // e.g. vbd.arithmetic; in a list fem.x for fem.0.x
    std::map<std::string, std::vector<std::string>> now;  // its value -> KEY=VALUE of the same table, VALUE in TOML
};

struct SceneSchema {
    std::vector<SceneKey> keys;
    std::vector<RenamedKey> renamed = {};

    const SceneKey* find(const std::string& path) const;  // e.g. "pbs.k_volume"; null: there is no such key
    bool is_table(const std::string& path) const;         // a table that has keys or tables
    bool is_list(const std::string& table) const;         // an array of tables
    std::string nearest_key(const std::string& path) const;
};

class SceneValues {
public:
    // Reads TOML text. `file` is its name in errors. An override is KEY=VALUE with VALUE in TOML (a bare word is a
    // text). InputError with the line for unknown keys, wrong types and values out of range.
    SceneValues(const std::string& text, const std::string& file, const std::vector<std::string>& overrides,
                SceneSchema schema);

    const nlohmann::json& value(const std::string& path) const;
    double number(const std::string& path) const { return value(path).get<double>(); }
    int integer(const std::string& path) const { return static_cast<int>(value(path).get<double>()); }
    std::string text(const std::string& path) const { return value(path).get<std::string>(); }
    std::vector<double> numbers(const std::string& path) const { return value(path).get<std::vector<double>>(); }
    std::vector<std::string> texts(const std::string& path) const
    {
        return value(path).get<std::vector<std::string>>();
    }

    bool given(const std::string& path) const { return values_.count(path) && !values_.at(path).is_default; }
    bool has_table(const std::string& table) const;  // fem.0 is the first table of a list
    // The number of [[list]] tables. The paths of their keys are fem.0.young_pa, fem.1.young_pa, ...
    int tables(const std::string& list) const { return lists_.count(list) ? lists_.at(list) : 0; }

    // Throws an InputError at the line of the key, or of the header of the table.
    [[noreturn]] void refuse(const std::string& path, const std::string& rule) const;
    nlohmann::json resolved() const;                                      // all keys, nested, for run.json
    const std::vector<std::string>& remarks() const { return remarks_; }  // a warning for each renamed key
    const std::string& file() const { return file_; }

private:
    struct Entry {
        nlohmann::json value;
        std::string source;
        int line = 0;
        bool is_default = false;
    };
    int index_in_list(const std::string& path) const;
    std::string schema_path(const std::string& path) const;
    friend class SceneReader;  // fills this object

    SceneSchema schema_;
    std::string file_;
    std::map<std::string, Entry> values_;
    std::map<std::string, int> tables_;  // table -> line of its header; 0: from --set
    std::map<std::string, int> lists_;   // list -> number of its tables
    std::vector<std::string> remarks_;
};

}  // namespace experiments

// A scene as checked values: every key of the schema with its value from the file, from --set or by default, and its place in the text.
#pragma once

#include "experiments/settings/scene_schema.hpp"

#include <nlohmann/json.hpp>

#include <map>
#include <string>
#include <vector>

namespace experiments {

class SceneValues {
public:
    // Reads TOML text. `file` is its name in errors. An override is KEY=VALUE with VALUE in TOML (a bare word is a text). InputError with
    // the line for unknown keys, wrong types and values out of range.
    SceneValues(const std::string& text, const std::string& file, const std::vector<std::string>& overrides, SceneSchema schema);

    double number(const std::string& path) const { return value(path).get<double>(); }
    int integer(const std::string& path) const { return static_cast<int>(value(path).get<double>()); }
    bool boolean(const std::string& path) const { return value(path).get<bool>(); }
    std::string text(const std::string& path) const { return value(path).get<std::string>(); }
    std::vector<double> numbers(const std::string& path) const { return value(path).get<std::vector<double>>(); }
    std::vector<std::string> texts(const std::string& path) const { return value(path).get<std::vector<std::string>>(); }
    std::vector<int> integers(const std::string& path) const { return value(path).get<std::vector<int>>(); }

    bool given(const std::string& path) const { return values_.count(path) && !values_.at(path).is_default; }
    bool has_table(const std::string& table) const;  // fem.0 is the first table of a list
    // The number of [[list]] tables. The paths of their keys are fem.0.young_pa, fem.1.young_pa, ...
    int tables(const std::string& list) const { return lists_.count(list) ? lists_.at(list) : 0; }

    // Throws an InputError at the line of the key, or of the header of the table.
    [[noreturn]] void refuse(const std::string& path, const std::string& rule) const;
    nlohmann::json resolved() const;  // all keys, nested, for run.json
    const std::string& file() const { return file_; }

private:
    struct Entry {
        nlohmann::json value;
        std::string source;
        int line = 0;
        bool is_default = false;
    };
    const nlohmann::json& value(const std::string& path) const;
    int index_in_list(const std::string& path) const;
    std::string schema_path(const std::string& path) const;
    friend class SceneReader;  // fills this object

    SceneSchema schema_;
    std::string file_;
    std::map<std::string, Entry> values_;
    std::map<std::string, int> tables_;  // table -> line of its header; 0: from --set
    std::map<std::string, int> lists_;   // list -> number of its tables
};

}  // namespace experiments

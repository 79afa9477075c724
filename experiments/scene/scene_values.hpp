// A scene as checked values: every key of the schema with what the file, --set or the default says, and where it was said.
#pragma once

#include <nlohmann/json.hpp>
#include <toml++/toml.h>

#include <map>
#include <string>
#include <vector>

namespace experiments {

class SceneValues {
public:
    // Reads TOML text; `file` stands for it in errors; overrides are KEY=VALUE with VALUE in TOML (a bare word is a text). Unknown keys,
    // wrong types and values out of range are InputErrors with the line.
    SceneValues(const std::string& text, const std::string& file, const std::vector<std::string>& overrides);

    double number(const std::string& path) const { return value(path).get<double>(); }
    int integer(const std::string& path) const { return static_cast<int>(value(path).get<double>()); }
    bool boolean(const std::string& path) const { return value(path).get<bool>(); }
    std::string text(const std::string& path) const { return value(path).get<std::string>(); }
    std::vector<double> numbers(const std::string& path) const { return value(path).get<std::vector<double>>(); }
    std::vector<std::string> texts(const std::string& path) const { return value(path).get<std::vector<std::string>>(); }
    std::vector<int> integers(const std::string& path) const { return value(path).get<std::vector<int>>(); }

    bool given(const std::string& path) const { return values_.count(path) && !values_.at(path).is_default; }
    bool has_table(const std::string& table) const;
    int fem_tables() const { return fem_tables_; }  // paths fem.0.young_pa, fem.1.young_pa, ...

    [[noreturn]] void refuse(const std::string& path, const std::string& rule) const;  // an InputError at the key's place
    nlohmann::json resolved() const;                                                   // nested, for run.json
    const std::string& file() const { return file_; }

private:
    struct Entry {
        nlohmann::json value;
        std::string source;
        int line = 0;
        bool is_default = false;
    };
    const nlohmann::json& value(const std::string& path) const;
    void take_table(const toml::table& table, const std::string& prefix);
    void take_override(const std::string& override);
    void take_value(const std::string& path, const toml::node& node, const std::string& source, int line);
    void add_defaults();

    std::string file_;
    std::map<std::string, Entry> values_;
    std::vector<std::string> tables_;
    int fem_tables_ = 0;
};

}  // namespace experiments

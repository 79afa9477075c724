#include "analysis/records/toml_keys.hpp"

#include "pbs/system/files.hpp"

#include <fmt/ranges.h>

namespace analysis {
namespace {

// The value as the file writes it, nothing for tables.
std::string value_text(const toml::node& node)
{
    if (node.is_string()) return fmt::format("\"{}\"", *node.value<std::string>());
    if (node.is_table() || node.is_array_of_tables()) return "";
    if (const toml::array* array = node.as_array()) {
        std::vector<std::string> values;
        for (const toml::node& value : *array) values.push_back(value_text(value));
        return fmt::format("[{}]", fmt::join(values, ", "));
    }
    std::ostringstream text;
    node.visit([&](const auto& value) { text << value; });
    return text.str();
}

}  // namespace

toml::table parse_toml(const std::string& text, const std::string& file)
{
    pbs::check_toml_keys(text, file);
    try {
        return toml::parse(text, file);
    } catch (const toml::parse_error& error) {
        throw pbs::InputError(file, static_cast<int>(error.source().begin.line), "", "",
                              std::string(error.description()));
    }
}

toml::table parse_toml_document(const std::string& text, const std::string& file, const std::set<std::string>& known)
{
    const toml::table document = parse_toml(text, file);
    for (const auto& [key, node] : document)
        if (key.str() != "schema" && !known.contains(std::string(key.str())))
            throw pbs::InputError(file, static_cast<int>(node.source().begin.line), std::string(key.str()), "",
                                  fmt::format("unknown key: expected schema or {}", fmt::join(known, " or ")));
    const toml::node* schema = document.get("schema");
    if (!schema) throw pbs::InputError(file, 0, "schema", "", "missing: expected schema = 1");
    if (schema->value_or(0) != 1)
        throw pbs::InputError(file, static_cast<int>(schema->source().begin.line), "schema", value_text(*schema),
                              "expected 1");
    return document;
}

std::vector<const toml::table*> toml_tables(const toml::table& parent, const std::string& name, const std::string& file)
{
    const toml::node* node = parent.get(name);
    if (!node) return {};
    const toml::array* array = node->as_array();
    if (!array || !array->is_homogeneous(toml::node_type::table))
        throw pbs::InputError(file, static_cast<int>(node->source().begin.line), name, "",
                              "expected [[" + name + "]] tables");
    std::vector<const toml::table*> tables;
    for (const toml::node& entry : *array) tables.push_back(entry.as_table());
    return tables;
}

void TomlKeys::require_nothing_unknown() const
{
    for (const auto& [key, node] : table_)
        if (!read_.contains(std::string(key.str())))
            throw pbs::InputError(file_, line_of(node), std::string(key.str()), "", "unknown key of a " + thing_);
}

void TomlKeys::refuse(const char* key, const std::string& rule, bool in_quotes) const
{
    const toml::node* node = table_.get(key);
    const std::string value = !node                             ? ""
                              : node->is_string() && !in_quotes ? *node->value<std::string>()
                                                                : value_text(*node);
    throw pbs::InputError(file_, node ? line_of(*node) : line(), key, value, rule);
}

}  // namespace analysis

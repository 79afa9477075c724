// Reads a TOML table key by key, for files whose every key is known: a key that was not read is an error with its line.
//   TomlKeys keys(table, "claims.toml", "claim");
//   keys.required("id", claim.id);  keys.optional("low", claim.low);  keys.require_nothing_unknown();
#pragma once

#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <set>
#include <string>
#include <type_traits>
#include <vector>

namespace analysis {

// InputError with the line for a text that is not TOML.
toml::table parse_toml(const std::string& text, const std::string& file);
// The same for a top-level key that is not in `known`; schema = 1 is required.
toml::table parse_toml_document(const std::string& text, const std::string& file, const std::set<std::string>& known);

// The tables of [[name]]; none if the name is missing. InputError if it is something else.
std::vector<const toml::table*> toml_tables(const toml::table& parent, const std::string& name,
                                            const std::string& file);

// Refers to table and file, which must outlive it.
class TomlKeys {
public:
    // thing: how messages call a table.
    TomlKeys(const toml::table& table, const std::string& file, const std::string& thing)
        : table_(table), file_(file), thing_(thing)
    {
    }

    // InputError at the line of the table if the key is missing, otherwise like optional().
    template <typename Value>
    void required(const char* key, Value& value)
    {
        if (!table_.contains(key)) throw pbs::InputError(file_, line(), key, "", "missing in this " + thing_);
        optional(key, value);
    }

    // `value` keeps its content if the key is missing; InputError for a value of another kind.
    template <typename Value>
    void optional(const char* key, Value& value)
    {
        read_.insert(key);
        const toml::node* node = table_.get(key);
        if (!node) return;
        const auto found = node->value<Value>();
        if (!found) refuse(key, expected<Value>(), true);
        value = *found;
    }

    // A list whose entries are appended to `values`. InputError if the value is not a list, or for an entry of another
    // kind.
    template <typename Value>
    void optional(const char* key, std::vector<Value>& values)
    {
        read_.insert(key);
        const toml::node* node = table_.get(key);
        if (!node) return;
        if (!node->is_array()) refuse(key, "expected a list", true);
        for (const toml::node& entry : *node->as_array()) {
            const auto found = entry.value<Value>();
            if (!found) refuse(key, expected<Value>() + " at each place of the list");
            values.push_back(*found);
        }
    }

    // for a key that the caller reads by node()
    void mark_read(const char* key) { read_.insert(key); }
    bool has(const char* key) const { return table_.contains(key); }           // whether or not it was read
    const toml::node* node(const char* key) const { return table_.get(key); }  // null if missing; not marked as read
    int line() const { return line_of(table_); }                               // line of the table, from 1
    // InputError at the first key that was not read
    void require_nothing_unknown() const;
    // Throws InputError at the place of the key. in_quotes: a text is shown with its quotes, for it stands in place of
    // another kind.
    [[noreturn]] void refuse(const char* key, const std::string& rule, bool in_quotes = false) const;

private:
    template <typename Value>
    static std::string expected()
    {
        if (std::is_same_v<Value, bool>) return "expected true or false";
        if (std::is_same_v<Value, std::string>) return "expected a text";
        constexpr bool whole = std::is_integral_v<Value>;
        return whole ? "expected a whole number" : "expected a number";
    }
    static int line_of(const toml::node& node) { return static_cast<int>(node.source().begin.line); }

    const toml::table& table_;
    const std::string& file_;
    std::string thing_;
    std::set<std::string> read_;
};

}  // namespace analysis

#include "experiments/scene/scene_values.hpp"

#include "analysis/records/record_text.hpp"
#include "experiments/scene/scene_schema.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/nearest_name.hpp"
#include "pbs/geometry/toml_text.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>
#include <string_view>

namespace experiments {
namespace {

using nlohmann::json;

json to_json(const toml::node& node)
{
    if (const auto* array = node.as_array()) {
        json values = json::array();
        for (const auto& element : *array) values.push_back(to_json(element));
        return values;
    }
    if (node.is_integer()) return node.as_integer()->get();
    if (node.is_floating_point()) return node.as_floating_point()->get();
    if (node.is_boolean()) return node.as_boolean()->get();
    if (node.is_string()) return node.as_string()->get();
    return nullptr;
}

std::string shown(const toml::node& node)
{
    const json value = to_json(node);
    if (node.is_floating_point() && !std::isfinite(value.get<double>())) return std::to_string(value.get<double>());  // JSON knows no nan
    return value.is_null() ? "(a table)" : value.is_string() ? value.get<std::string>() : value.dump();
}

bool is_number(const json& value, const SceneKey& key)
{
    if (!value.is_number()) return false;
    const double number = value.get<double>();
    return std::isfinite(number) && number >= key.lowest && number <= key.highest;
}

bool is_list(const json& value, std::size_t size, auto&& each)
{
    return value.is_array() && (size == 0 || value.size() == size) && std::all_of(value.begin(), value.end(), each);
}

bool obeys(const json& value, const SceneKey& key)
{
    const auto number = [&](const json& element) { return is_number(element, key); };
    switch (key.type) {
        case KeyType::text:
            return value.is_string() &&
                   (key.choices.empty() || std::count(key.choices.begin(), key.choices.end(), value.get<std::string>()));
        case KeyType::number:
            return is_number(value, key);
        case KeyType::integer:
            return value.is_number_integer() && is_number(value, key);
        case KeyType::boolean:
            return value.is_boolean();
        case KeyType::vec3:
            return is_list(value, 3, number);
        case KeyType::numbers:
            return is_list(value, 0, number);
        case KeyType::texts:
            return is_list(value, 0, [](const json& element) { return element.is_string(); });
        case KeyType::integers:
            return is_list(value, 0, [&](const json& element) { return element.is_number_integer() && number(element); });
    }
    return false;
}

std::vector<std::string> known_names(const std::string& table)
{
    std::set<std::string> names;
    for (const auto& key : scene_keys()) {
        if (key.table == table) names.insert(key.name);
        if (table.empty() && !key.table.empty()) names.insert(key.table.substr(0, key.table.find('.')));
        if (key.table.size() > table.size() && key.table.starts_with(table + ".")) names.insert(key.table.substr(table.size() + 1));
    }
    return {names.begin(), names.end()};
}

std::string joined(const std::string& table, const std::string& name)
{
    return table.empty() ? name : table + "." + name;
}

// In the path's own table, else in the nearest one around it that there is.
std::string nearest_key(const std::string& path)
{
    const auto dot = path.rfind('.');
    if (dot == std::string::npos) return pbs::nearest_name(path, known_names(""));
    const std::string table = path.substr(0, dot);
    const std::vector<std::string> known = known_names(table);
    return known.empty() ? nearest_key(table) : joined(table, pbs::nearest_name(path.substr(dot + 1), known));
}

bool is_table_name(const std::string& path)
{
    return std::any_of(scene_keys().begin(), scene_keys().end(),
                       [&](const SceneKey& key) { return key.table == path || key.table.starts_with(path + "."); });
}

toml::table parse(const std::string& text, const std::string& file)
{
    pbs::check_toml_keys(text, file);
    try {
        return toml::parse(text, file);
    } catch (const toml::parse_error& error) {
        throw pbs::InputError(file, static_cast<int>(error.source().begin.line), "", "", std::string(error.description()));
    }
}

// VALUE of --set as TOML, or as a bare text.
toml::table parse_override(const std::string& value)
{
    try {
        pbs::check_toml_keys(value, "--set");
        toml::table table = toml::parse("value = " + value);
        if (table.size() == 1) return table;
    } catch (const toml::parse_error&) {
    } catch (const pbs::InputError&) {
    }
    return toml::table{{"value", value}};
}

constexpr std::string_view fem_prefix = "fem.";

// The index of fem.INDEX.KEY as a scene writes it, without leading zeros; nothing of other paths.
std::optional<int> fem_index(const std::string& path)
{
    if (!path.starts_with(fem_prefix)) return std::nullopt;
    const auto dot = path.find('.', fem_prefix.size());
    if (dot == std::string::npos) return std::nullopt;
    const std::string written = path.substr(fem_prefix.size(), dot - fem_prefix.size());
    int index = 0;
    const auto [end, error] = std::from_chars(written.data(), written.data() + written.size(), index);
    return error == std::errc() && index >= 0 && std::to_string(index) == written ? std::optional(index) : std::nullopt;
}

// fem.0.young_pa -> fem.young_pa: the schema knows one [[fem]] table.
std::string schema_path(const std::string& path)
{
    return fem_index(path) ? "fem" + path.substr(path.find('.', fem_prefix.size())) : path;
}

}  // namespace

SceneValues::SceneValues(const std::string& text, const std::string& file, const std::vector<std::string>& overrides) : file_(file)
{
    take_table(parse(text, file), "");
    for (const std::string& override : overrides) take_override(override);
    if (!values_.count("schema")) throw pbs::InputError(file, 0, "schema", "", "missing; write schema = 1");
    add_defaults();
}

void SceneValues::take_table(const toml::table& table, const std::string& prefix)
{
    for (const auto& [key, node] : table) {
        const std::string name(key.str()), path = joined(prefix, name);
        const int line = static_cast<int>(node.source().begin.line);
        if (name.find('.') != std::string::npos) throw pbs::InputError(file_, line, path, "", "expected a key without a dot in quotes");
        if (node.is_table() && path != "fem" && is_table_name(schema_path(path))) {
            tables_.push_back(path);
            take_table(*node.as_table(), path);
        } else if (path == "fem" && node.is_array_of_tables()) {
            for (const auto& element : *node.as_array()) take_table(*element.as_table(), "fem." + std::to_string(fem_tables_++));
        } else if (path == "fem" || is_table_name(path)) {
            throw pbs::InputError(file_, line, path, "", path == "fem" ? "expected [[fem]] tables" : "expected a table");
        } else {
            take_value(path, node, file_, line);
        }
    }
}

// KEY=VALUE; a key of fem without an index is of the first table.
void SceneValues::take_override(const std::string& override)
{
    const auto equals = override.find('=');
    if (equals == std::string::npos || equals == 0) throw pbs::InputError("--set", 0, "", override, "expected key=value");
    std::string path = override.substr(0, equals);
    const std::string value = override.substr(equals + 1);
    if (!analysis::is_utf8(override)) throw pbs::InputError("--set", 0, path, value, "expected UTF-8");
    if (path.starts_with(fem_prefix)) {
        if (fem_tables_ > 0 && find_scene_key(path)) path.insert(fem_prefix.size(), "0.");
        if (fem_index(path).value_or(0) >= fem_tables_)
            throw pbs::InputError("--set", 0, path, value, "the scene has no such [[fem]] table");
    }
    take_value(path, *parse_override(value).get("value"), "--set", 0);
    if (const auto dot = path.rfind('.'); dot != std::string::npos) tables_.push_back(path.substr(0, dot));
}

void SceneValues::take_value(const std::string& path, const toml::node& node, const std::string& source, int line)
{
    const std::string of_schema = schema_path(path);
    const SceneKey* key = find_scene_key(of_schema);
    if (!key)
        throw pbs::InputError(source, line, path, node.is_table() ? "" : shown(node),
                              "unknown key; the nearest known one is " + nearest_key(of_schema));
    const json value = to_json(node);
    if (!obeys(value, *key)) throw pbs::InputError(source, line, path, shown(node), key->rule());
    values_[path] = {value, source, line, false};
}

void SceneValues::add_defaults()
{
    for (const auto& key : scene_keys()) {
        if (key.default_json.empty()) continue;
        const Entry entry{json::parse(key.default_json), file_, 0, true};
        if (key.table != "fem") {
            if (!key.table.starts_with("pbs.") || has_table(key.table)) values_.emplace(key.path(), entry);
            continue;
        }
        for (int i = 0; i < fem_tables_; ++i) values_.emplace("fem." + std::to_string(i) + "." + key.name, entry);
    }
}

bool SceneValues::has_table(const std::string& table) const
{
    return std::count(tables_.begin(), tables_.end(), table) > 0;
}

const json& SceneValues::value(const std::string& path) const
{
    const auto found = values_.find(path);
    if (found != values_.end()) return found->second.value;
    const SceneKey* key = find_scene_key(schema_path(path));
    throw pbs::InputError(file_, 0, path, "",
                          "missing: the paper leaves it unstated, so every scene states it; " + (key ? key->rule() : ""));
}

void SceneValues::refuse(const std::string& path, const std::string& rule) const
{
    const auto found = values_.find(path);
    if (found == values_.end()) throw pbs::InputError(file_, 0, path, "", rule);
    const Entry& entry = found->second;
    throw pbs::InputError(entry.source, entry.line, path, entry.value.is_string() ? entry.value.get<std::string>() : entry.value.dump(),
                          rule);
}

json SceneValues::resolved() const
{
    json scene = json::object();
    for (const auto& [path, entry] : values_) {
        std::string pointer = "/" + path;
        std::replace(pointer.begin(), pointer.end(), '.', '/');
        scene[json::json_pointer(pointer)] = entry.value;
    }
    return scene;
}

}  // namespace experiments

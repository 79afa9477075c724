#include "experiments/settings/scene_values.hpp"

#include "analysis/records/record_files.hpp"
#include "analysis/records/toml_keys.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/system/files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <utility>

namespace experiments {
namespace {

// The keys and tables of a table; "" is the top level.
std::vector<std::string> known_names(const std::vector<SceneKey>& keys, const std::string& table)
{
    std::set<std::string> names;
    for (const SceneKey& key : keys) {
        if (key.table == table) names.insert(key.name);
        if (table.empty() && !key.table.empty()) names.insert(key.table.substr(0, key.table.find('.')));
        if (key.table.size() > table.size() && key.table.starts_with(table + "."))
            names.insert(key.table.substr(table.size() + 1));
    }
    return {names.begin(), names.end()};
}

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

// A text without its quotes where a text is expected, otherwise as the file writes it: "1" is no number.
std::string shown(const toml::node& node, bool in_quotes = false)
{
    const json value = to_json(node);
    // JSON has no nan
    if (node.is_floating_point() && !std::isfinite(value.get<double>())) return std::to_string(value.get<double>());
    return value.is_null() ? "(a table)" : value.is_string() && !in_quotes ? value.get<std::string>() : value.dump();
}

bool is_number(const json& value, const SceneKey& key)
{
    if (!value.is_number()) return false;
    const double number = value.get<double>();
    return std::isfinite(number) && number >= key.range.lowest && number <= key.range.highest;
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
            return value.is_string() && (key.choices.empty() ||
                                         std::count(key.choices.begin(), key.choices.end(), value.get<std::string>()));
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
            return is_list(value, 0,
                           [&](const json& element) { return element.is_number_integer() && number(element); });
    }
    return false;
}

std::string joined(const std::string& table, const std::string& name)
{
    return table.empty() ? name : table + "." + name;
}

// The VALUE of --set, as TOML or else as a bare text.
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
    static constexpr const char* names[] = {"a text",          "a number",          "an integer",
                                            "true or false",   "three numbers",     "a list of numbers",
                                            "a list of texts", "a list of integers"};
    std::string words = fmt::format("expected {}", names[static_cast<int>(type)]);
    const auto& [lowest, highest] = range;
    if (lowest == highest) return fmt::format("expected {:g}", lowest);
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
    const auto found =
        std::ranges::find_if(keys, [&](const SceneKey& key) { return path.ends_with(key.name) && key.path() == path; });
    return found == keys.end() ? nullptr : &*found;
}

bool SceneSchema::is_table(const std::string& path) const
{
    const std::string inside = path + ".";
    return std::any_of(keys.begin(), keys.end(),
                       [&](const SceneKey& key) { return key.table == path || key.table.starts_with(inside); });
}

bool SceneSchema::is_list(const std::string& table) const
{
    return std::any_of(keys.begin(), keys.end(),
                       [&](const SceneKey& key) { return key.in_list && key.table == table; });
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

// The index in a path LIST.INDEX.KEY, written without leading zeros; -1 for other paths.
int SceneValues::index_in_list(const std::string& path) const
{
    const auto first = path.find('.'), second = first == std::string::npos ? first : path.find('.', first + 1);
    if (second == std::string::npos || !schema_.is_list(path.substr(0, first))) return -1;
    const std::string written = path.substr(first + 1, second - first - 1);
    int index = 0;
    const auto [end, error] = std::from_chars(written.data(), written.data() + written.size(), index);
    return error == std::errc() && index >= 0 && std::to_string(index) == written ? index : -1;
}

// fem.0.young_pa -> fem.young_pa, for the schema has one table per list.
std::string SceneValues::schema_path(const std::string& path) const
{
    if (index_in_list(path) < 0) return path;
    const auto first = path.find('.');
    return path.substr(0, first) + path.substr(path.find('.', first + 1));
}

// Fills SceneValues from the text of a scene and from overrides.
class SceneReader {
public:
    explicit SceneReader(SceneValues& scene) : scene_(scene) {}

    void take_table(const toml::table& table, const std::string& prefix)
    {
        for (const auto& [key, node] : table) {
            const std::string name(key.str()), path = joined(prefix, name);
            const int line = static_cast<int>(node.source().begin.line);
            if (name.find('.') != std::string::npos)
                throw pbs::InputError(scene_.file_, line, path, "", "expected a key without a dot in quotes");
            const bool is_list = scene_.schema_.is_list(path);
            if (is_list && node.is_array_of_tables()) {
                for (const auto& element : *node.as_array()) {
                    const std::string table_path = joined(path, std::to_string(scene_.lists_[path]++));
                    scene_.tables_.emplace(table_path, static_cast<int>(element.source().begin.line));
                    take_table(*element.as_table(), table_path);
                }
            } else if (is_list) {
                throw pbs::InputError(scene_.file_, line, path, "", "expected [[" + path + "]] tables");
            } else if (node.is_table() && scene_.schema_.is_table(scene_.schema_path(path))) {
                scene_.tables_.emplace(path, line);
                take_table(*node.as_table(), path);
            } else if (scene_.schema_.is_table(path)) {
                throw pbs::InputError(scene_.file_, line, path, "", "expected a table");
            } else {
                take_value(path, node, scene_.file_, line);
            }
        }
    }

    // KEY=VALUE. A key of a list without an index means the first table.
    void take_override(const std::string& override)
    {
        const auto equals = override.find('=');
        if (equals == std::string::npos || equals == 0)
            throw pbs::InputError("--set", 0, "", override, "expected key=value");
        std::string path = override.substr(0, equals);
        const std::string value = override.substr(equals + 1);
        if (!analysis::is_utf8(override)) throw pbs::InputError("--set", 0, path, value, "expected UTF-8");
        if (const auto dot = path.find('.'); dot != std::string::npos && scene_.schema_.is_list(path.substr(0, dot))) {
            const std::string list = path.substr(0, dot);
            if (scene_.tables(list) > 0 && scene_.schema_.find(path)) path.insert(dot + 1, "0.");
            if (std::max(scene_.index_in_list(path), 0) >= scene_.tables(list))
                throw pbs::InputError("--set", 0, path, value, "the scene has no such [[" + list + "]] table");
        }
        take_value(path, *parse_override(value).get("value"), "--set", 0);
        if (const auto dot = path.rfind('.'); dot != std::string::npos) scene_.tables_.emplace(path.substr(0, dot), 0);
    }

    void take_value(const std::string& path, const toml::node& node, const std::string& source, int line)
    {
        const std::string of_schema = scene_.schema_path(path);
        const SceneKey* key = scene_.schema_.find(of_schema);
        for (const RenamedKey& renamed : scene_.schema_.renamed)
            if (!key && renamed.path == of_schema) return take_renamed(renamed, path, node, source, line);
        if (!key)
            throw pbs::InputError(source, line, path, node.is_table() ? "" : shown(node),
                                  "unknown key; the nearest known one is " + scene_.schema_.nearest_key(of_schema));
        const json value = to_json(node);
        if (!obeys(value, *key))
            throw pbs::InputError(source, line, path, shown(node, key->type != KeyType::text), key->rule());
        scene_.values_[path] = {value, source, line, false};
    }

    void take_renamed(const RenamedKey& renamed, const std::string& path, const toml::node& node,
                      const std::string& source, int line)
    {
        const auto now = renamed.now.find(shown(node));
        if (now == renamed.now.end()) {
            std::vector<std::string> values;
            for (const auto& [value, keys] : renamed.now) values.push_back(value);
            throw pbs::InputError(source, line, path, shown(node),
                                  fmt::format("expected one of {}", fmt::join(values, ", ")));
        }
        const std::string table = path.substr(0, path.rfind('.') + 1);
        std::vector<std::string> keys;
        for (const std::string& key : now->second) {
            const auto equals = key.find('=');
            const toml::table value = parse_override(key.substr(equals + 1));
            keys.push_back(fmt::format("{}{} = {}", table, key.substr(0, equals), to_json(*value.get("value")).dump()));
            take_value(table + key.substr(0, equals), *value.get("value"), source, line);
        }
        scene_.remarks_.push_back(pbs::InputError(source, line, path, shown(node),
                                                  fmt::format("is renamed: write {}", fmt::join(keys, " and ")))
                                      .what());
    }

    void add_defaults()
    {
        for (const SceneKey& key : scene_.schema_.keys) {
            if (key.default_json.empty()) continue;
            const SceneValues::Entry entry{json::parse(key.default_json), scene_.file_, 0, true};
            const bool is_table_in_table = key.table.find('.') != std::string::npos;
            if (key.in_list)
                for (int i = 0; i < scene_.tables(key.table); ++i)
                    scene_.values_.emplace(joined(joined(key.table, std::to_string(i)), key.name), entry);
            else if (!is_table_in_table || scene_.has_table(key.table))
                scene_.values_.emplace(key.path(), entry);
        }
    }

private:
    SceneValues& scene_;
};

SceneValues::SceneValues(const std::string& text, const std::string& file, const std::vector<std::string>& overrides,
                         SceneSchema schema)
    : schema_(std::move(schema)), file_(file)
{
    SceneReader reader(*this);
    reader.take_table(analysis::parse_toml(text, file), "");
    for (const std::string& override : overrides) reader.take_override(override);
    if (!values_.count("schema")) throw pbs::InputError(file, 0, "schema", "", "missing; write schema = 1");
    reader.add_defaults();
}

bool SceneValues::has_table(const std::string& table) const
{
    return tables_.contains(table);
}

const json& SceneValues::value(const std::string& path) const
{
    const auto found = values_.find(path);
    if (found != values_.end()) return found->second.value;
    const SceneKey* key = schema_.find(schema_path(path));
    const std::string who = key && key->in_list ? "every [[" + key->table + "]] table states it; "
                                                : "the paper leaves it unstated, so every scene states it; ";
    throw pbs::InputError(file_, 0, path, "", "missing: " + who + (key ? key->rule() : ""));
}

void SceneValues::refuse(const std::string& path, const std::string& rule) const
{
    const auto found = values_.find(path);
    if (found == values_.end()) {
        const auto table = tables_.find(path);
        throw pbs::InputError(file_, table == tables_.end() ? 0 : table->second, path, "", rule);
    }
    const Entry& entry = found->second;
    throw pbs::InputError(entry.source, entry.line, path,
                          entry.value.is_string() ? entry.value.get<std::string>() : entry.value.dump(), rule);
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

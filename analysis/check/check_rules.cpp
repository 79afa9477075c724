// Reads the rules of a check from TOML: parse_check_rules of check.hpp.

#include "analysis/check/check.hpp"

#include "analysis/records/toml_keys.hpp"
#include "pbs/geometry/input_error.hpp"

#include <algorithm>
#include <cmath>

namespace analysis {
namespace {

using Names = std::vector<std::string>;

// Refuses the key if `known` does not contain the name. rule: what is wrong with the name.
void require_known(const TomlKeys& keys, const char* key, const std::string& name, const Names& known,
                   const std::string& rule)
{
    if (std::count(known.begin(), known.end(), name)) return;
    keys.refuse(key, rule + (known.empty() ? "" : "; the nearest known one is " + pbs::nearest_name(name, known)));
}

void require_metric(const TomlKeys& keys, const std::string& metric, const Names& metrics)
{
    if (metric == "step_ms") keys.refuse("metric", "wall time is tracked, never judged");
    require_known(keys, "metric", metric, metrics, "unknown metric");
}

// before: the names of the scenes that were read before this one.
CheckScene read_scene(const toml::table& table, const std::string& file, const Names& before)
{
    TomlKeys keys(table, file, "scene of a check");
    CheckScene scene;
    scene.line = keys.line();
    keys.required("scene", scene.scene);
    scene.name = scene.scene;
    keys.optional("name", scene.name);
    keys.optional("set", scene.set);
    keys.optional("needs", scene.needs);
    keys.require_nothing_unknown();
    const auto is_plain = [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; };
    if (scene.name.empty() || !std::all_of(scene.name.begin(), scene.name.end(), is_plain))
        keys.refuse(keys.has("name") ? "name" : "scene",
                    "expected a `name` of letters, digits, _ and -: it names the records' folder");
    if (std::count(before.begin(), before.end(), scene.name)) keys.refuse("name", "expected each name of a scene once");
    return scene;
}

CheckBound read_bound(const toml::table& table, const std::string& file, const Names& scenes, const Names& metrics)
{
    TomlKeys keys(table, file, "bound of a check");
    CheckBound bound;
    bound.line = keys.line();
    keys.required("name", bound.name);
    keys.required("scene", bound.scene);
    keys.required("deformer", bound.deformer);
    keys.required("metric", bound.metric);
    keys.optional("low", bound.low);
    keys.optional("high", bound.high);
    keys.optional("frames", bound.frames);
    keys.required("why", bound.why);
    keys.require_nothing_unknown();
    require_known(keys, "scene", bound.scene, scenes, "expected a scene of this file");
    require_metric(keys, bound.metric, metrics);
    if (!keys.has("low") && !keys.has("high")) keys.refuse("low", "expected low, high or both");
    for (const auto& [key, value] : {std::pair("low", bound.low), std::pair("high", bound.high)})
        if (keys.has(key) && !std::isfinite(value))
            keys.refuse(key, "expected a finite number: all or nothing would hold");
    if (bound.low > bound.high) keys.refuse("low", "expected low <= high");
    const std::vector<int>& frames = bound.frames;
    if (keys.has("frames") && (frames.size() != 2 || frames[0] < 0 || frames[0] > frames[1]))
        keys.refuse("frames", "expected [first, last], 0 <= first <= last");
    return bound;
}

CheckTolerance read_tolerance(const toml::table& table, const std::string& file, const Names& metrics)
{
    TomlKeys keys(table, file, "tolerance of a check");
    CheckTolerance tolerance;
    tolerance.line = keys.line();
    keys.required("metric", tolerance.metric);
    keys.optional("absolute", tolerance.absolute);
    keys.optional("relative", tolerance.relative);
    keys.required("why", tolerance.why);
    keys.require_nothing_unknown();
    require_metric(keys, tolerance.metric, metrics);
    for (const auto& [key, value] :
         {std::pair("absolute", tolerance.absolute), std::pair("relative", tolerance.relative)})
        if (!(value >= 0.0 && std::isfinite(value))) keys.refuse(key, "expected a number >= 0");
    return tolerance;
}

// Refuses entries that have the same name.
template <typename Entry>
void require_once(const std::vector<Entry>& entries, std::string Entry::*name, const char* key, const std::string& file)
{
    for (std::size_t i = 0; i < entries.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (entries[i].*name == entries[j].*name)
                throw pbs::InputError(file, entries[i].line, key, entries[i].*name, "expected once");
}

}  // namespace

CheckRules parse_check_rules(const std::string& text, const std::string& file, const std::vector<std::string>& metrics)
{
    const toml::table document = parse_toml_document(text, file, {"check", "claim", "quantity"});
    const toml::table* check = document["check"].as_table();
    if (!check) throw pbs::InputError(file, 0, "check", "", "expected [[check.scene]] and [[check.bound]] tables");
    TomlKeys keys(*check, file, "check");
    for (const char* known : {"scene", "bound", "tolerance"}) keys.mark_read(known);
    keys.require_nothing_unknown();

    CheckRules rules{file, {}, {}, {}};
    Names scenes;
    for (const toml::table* table : toml_tables(*check, "scene", file)) {
        rules.scenes.push_back(read_scene(*table, file, scenes));
        scenes.push_back(rules.scenes.back().name);
    }
    if (scenes.empty()) throw pbs::InputError(file, 0, "check.scene", "", "expected at least one [[check.scene]]");
    for (const toml::table* table : toml_tables(*check, "bound", file))
        rules.bounds.push_back(read_bound(*table, file, scenes, metrics));
    for (const toml::table* table : toml_tables(*check, "tolerance", file))
        rules.tolerances.push_back(read_tolerance(*table, file, metrics));
    require_once(rules.bounds, &CheckBound::name, "name", file);
    require_once(rules.tolerances, &CheckTolerance::metric, "metric", file);
    return rules;
}

}  // namespace analysis

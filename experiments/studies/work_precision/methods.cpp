#include "experiments/studies/work_precision/methods.hpp"

#include "experiments/characters/skinning_weights.hpp"
#include "experiments/deformers/correctives.hpp"
#include "experiments/deformers/deformer_options.hpp"
#include "experiments/deformers/external/external_deformers.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/process/child_process.hpp"
#include "experiments/settings/scene_values.hpp"
#include "experiments/studies/study.hpp"
#include "generated/chosen_texts.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/topology.hpp"
#include "pbs/solver/constraint_set.hpp"
#include "pbs/solver/options.hpp"
#include "pbs/system/files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <sstream>
#include <stdexcept>

namespace experiments {

const analysis::Columns<ChosenSetting> chosen_columns =
    MEMBER_COLUMNS(ChosenSetting, budget_ms, method, setting, training_ms, training_error_pct);

namespace {

const nlohmann::json& document()
{
    static const nlohmann::json read = cases_document("work_precision");
    return read;
}

// Keys that are no keys of a scene.
constexpr const char *young_factor = "young_factor=", *other_kind = "kind=";

bool is_of_scene(const std::string& key)
{
    return !key.starts_with(young_factor) && !key.starts_with(other_kind);
}

bool exist(const KeyValues& keys)
{
    static const SceneSchema schema = scene_schema();
    return std::ranges::all_of(keys, [&](const std::string& key) {
        if (key.starts_with(other_kind))
            return find_deformer_kind(key.substr(std::string(other_kind).size())) != nullptr;
        return !is_of_scene(key) || schema.find(key.substr(0, key.find('='))) != nullptr;
    });
}

ComparedMethod method_in(const nlohmann::json& table)
{
    ComparedMethod method;
    for (const auto& [key, value] : table.items()) {
        if (key == "name")
            value.get_to(method.name);
        else if (key == "kind")
            value.get_to(method.kind);
        else if (key == "takes")
            value.get_to(method.takes);
        else if (key == "overrides")
            value.get_to(method.overrides);
        else if (key == "grid")
            value.get_to(method.grid);
        else if (key == "iterations_key")
            value.get_to(method.iterations_key);
        else if (key == "iterations")
            value.get_to(method.iterations);
        else if (key == "tables")
            value.get_to(method.tables);
        else if (key == "k_by_edge_length")
            value.get_to(method.k_by_edge_length);
        else
            throw std::logic_error("work_precision/cases.toml: nothing reads the key " + key + " of a method");
    }
    std::erase_if(method.grid, [](const KeyValues& keys) { return !exist(keys); });
    return method;
}

bool is_available(const ComparedMethod& method)
{
    KeyValues keys = method.overrides;
    if (!method.iterations_key.empty()) keys.push_back(method.iterations_key);
    return find_deformer_kind(method.kind) && exist(keys);
}

std::string assigned(const std::string& key, double value)
{
    return fmt::format("{}={:.17g}", key, value);
}

// What a method takes of a member's flesh, as keys of its table.
KeyValues flesh_keys(const ComparedMethod& method, const std::string& table, const DeformerSpec& flesh,
                     double young_times)
{
    const auto& fem = options_of<FemOptions>(flesh);
    const auto takes = [&](const char* what) { return std::ranges::count(method.takes, what) > 0; };
    KeyValues keys;
    if (takes("material")) keys.push_back(assigned(table + ".poisson", fem.poisson));
    if (takes("material") && table == "xpbd") keys.push_back(assigned("xpbd.young_pa", young_times * fem.young_pa));
    if (!takes("attachment")) return keys;
    keys.push_back(table + ".attachment=" + name_of(fem.attachment));
    keys.push_back(assigned(table + ".core_radius", fem.used_core_radius()));
    keys.push_back(assigned(table + ".spring_factor", fem.used_spring_factor()));
    return keys;
}

const std::string& text_of(const Scene& scene)
{
    for (const BuiltInScene& built_in : built_in_scenes())
        if (built_in.name == scene.name) return built_in.text;
    throw std::logic_error("methods are compared in built-in scenes, not in " + scene.name);
}

std::vector<double> edge_lengths_m(const pbs::TetMesh& mesh)
{
    const pbs::Edges edges = pbs::edges_of(mesh.tets);
    std::vector<double> lengths;
    for (const auto edge : edges.rowwise()) lengths.push_back((mesh.rest.row(edge(0)) - mesh.rest.row(edge(1))).norm());
    return lengths;
}

// Why the library cannot be used, or an empty text if it can. It is loaded in another process, which it may end.
std::string why_not_loadable(const std::string& library)
{
    try {
        return in_own_process([&] { return nlohmann::json(why_library_not_usable(library)); }).get<std::string>();
    } catch (const std::runtime_error& error) {
        return std::string("cannot be loaded: ") + error.what();
    }
}

void check_external(const SceneValues& values, const std::string& table, const DeformerSpec& spec)
{
    if (spec.name == "reference" || std::ranges::count(methods(), spec.name, &ComparedMethod::name) > 0 ||
        std::ranges::count(other_starts(), spec.name, &OtherStart::name) > 0)
        values.refuse(table + ".name", "expected a name that no method or row of the comparison has");
    const auto& options = options_of<ExternalOptions>(spec);
    const bool is_command = options.library.empty();
    const std::string why_not =
        is_command ? why_not_startable(options.command.front()) : why_not_loadable(options.library);
    if (why_not.empty()) return;
    values.refuse(table + (is_command ? ".command" : ".library"), (is_command ? "cannot be started: " : "") + why_not);
}

}  // namespace

bool ComparedMethod::is_in(const std::string& table) const
{
    return std::ranges::count(tables, table) > 0;
}

const std::vector<ComparedMethod>& methods()
{
    static const std::vector<ComparedMethod> available = [] {
        std::vector<ComparedMethod> compared_methods;
        for (const nlohmann::json& table : document().at("method"))
            if (ComparedMethod method = method_in(table); is_available(method))
                compared_methods.push_back(std::move(method));
        return compared_methods;
    }();
    return available;
}

const std::vector<OtherStart>& other_starts()
{
    static const std::vector<OtherStart> other_starts = [] {
        std::vector<OtherStart> starts;
        for (const nlohmann::json& table : document().at("start"))
            starts.push_back({table.at("name"), table.at("of"), table.at("overrides")});
        std::erase_if(starts, [](const OtherStart& start) {
            return !exist(start.overrides) || std::ranges::count(methods(), start.of, &ComparedMethod::name) == 0;
        });
        return starts;
    }();
    return other_starts;
}

const ComparisonTimes& comparison_times()
{
    static const ComparisonTimes times = {document().at("budgets_ms"), document().at("tables_ms")};
    return times;
}

std::vector<EnsembleMember> training_members()
{
    const std::vector<std::string> names = document().at("training_members");
    std::vector<EnsembleMember> members = family();
    std::erase_if(members, [&](const EnsembleMember& member) { return std::ranges::count(names, member.name) == 0; });
    return members;
}

std::vector<std::string> start_poses()
{
    return document().at("start_poses");
}

std::string Setting::text() const
{
    return fmt::format("{}", fmt::join(keys, " "));
}

KeyValues keys_in(const std::string& setting)
{
    std::istringstream text(setting);
    return {std::istream_iterator<std::string>(text), {}};
}

std::vector<Setting> tried_settings(const ComparedMethod& method, const KeyValues& of_grid)
{
    if (method.iterations.empty()) return {{&method, of_grid}};
    std::vector<Setting> settings;
    for (const int iterations : method.iterations) {
        Setting& setting =
            settings.emplace_back(Setting{&method, {fmt::format("{}={}", method.iterations_key, iterations)}});
        setting.keys.insert(setting.keys.end(), of_grid.begin(), of_grid.end());
    }
    return settings;
}

DeformerSpec spec_of(const Setting& setting, const Scene& scene, const pbs::Character& character,
                     const EnsembleMember& member)
{
    const ComparedMethod& method = *setting.method;
    if (method.kind.empty()) return method.external;
    if (method.is_learned()) {
        DeformerSpec learned = kept_correctives(scene.character.body);
        learned.name = learned.label = method.name;
        return learned;
    }
    std::string kind = method.kind;
    double young_times = 1.0;
    for (const std::string& key : setting.keys) {
        if (key.starts_with(other_kind)) kind = key.substr(std::string(other_kind).size());
        if (key.starts_with(young_factor)) young_times = std::stod(key.substr(std::string(young_factor).size()));
    }
    KeyValues keys = method.overrides;
    if (method.takes_flesh())
        for (std::string& key : flesh_keys(method, method.kind, flesh_of(reference_flesh(scene), member), young_times))
            keys.push_back(std::move(key));
    // a later value of a key is the one that counts
    std::ranges::copy_if(setting.keys, std::back_inserter(keys), is_of_scene);
    const DeformerKind& registered = *find_deformer_kind(kind);
    std::string text = text_of(scene), table = kind;
    if (registered.has_list) text += fmt::format("\n[[{}]]\nname = \"{}\"\n", kind, method.name);
    const SceneValues values(text, scene.file, keys, scene_schema());
    if (registered.has_list) table += fmt::format(".{}", values.tables(kind) - 1);
    DeformerSpec spec = default_spec(kind);
    if (registered.read) registered.read(values, table, spec);
    spec.name = spec.label = method.name;
    spec.threads = 1;
    if (values.given("skinning.weights")) spec.weights = pbs::weights_named(values.text("skinning.weights"));
    if (auto* pbs = std::any_cast<pbs::PbsOptions>(&spec.options)) {
        pbs->jiggle.reset();
        if (method.k_by_edge_length)
            pbs->k_stretch_length_m = neutral_length(pbs->k_stretch, edge_lengths_m(character.mesh));
    }
    return spec;
}

const std::vector<ChosenSetting>& kept_settings()
{
    static const std::vector<ChosenSetting> kept =
        rows_of(chosen_columns, analysis::parse_csv(chosen::settings_csv, "work_precision/settings.csv"));
    return kept;
}

std::vector<ComparedMethod> external_methods(const std::string& file)
{
    std::error_code code;
    if (!std::filesystem::is_regular_file(file, code))
        throw pbs::InputError(file, 0, "", "",
                              "cannot be read: expected a file with schema = 1 and [[external]] tables");
    const std::string own = external_kind().name;
    const SceneValues values(pbs::read_text_file(file), file, {}, scene_schema());
    for (const SceneKey& key : scene_schema().keys) {
        const std::string table = key.in_list ? key.table + ".0" : key.table;
        if (key.table != own && values.has_table(table)) values.refuse(table, "expected only [[" + own + "]] tables");
    }
    const std::vector<DeformerSpec> entries = listed_deformers(values);
    if (entries.empty())
        throw pbs::InputError(file, 0, own, "", "missing: expected at least one [[" + own + "]] table");
    std::vector<ComparedMethod> compared_methods;
    for (std::size_t i = 0; i < entries.size(); ++i) {
        check_external(values, own + "." + std::to_string(i), entries[i]);
        compared_methods.push_back({.name = entries[i].name, .tables = {"known", "guessed"}, .external = entries[i]});
    }
    return compared_methods;
}

double neutral_length(double k, const std::vector<double>& edge_lengths_m)
{
    const double longest = std::ranges::max(edge_lengths_m);
    const auto mean_k = [&](double length_m) {
        double sum = 0.0;
        for (const double l : edge_lengths_m) sum += pbs::stiffness_at_length(k, l, length_m);
        return sum / double(edge_lengths_m.size());
    };
    double low = std::ranges::min(edge_lengths_m), high = longest;  // all are at most k, at least k
    while (high - low > 1e-12 * longest) {
        const double middle = std::midpoint(low, high);
        (mean_k(middle) < k ? low : high) = middle;
    }
    return high;
}

}  // namespace experiments

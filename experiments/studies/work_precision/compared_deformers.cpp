#include "experiments/studies/work_precision/compared_deformers.hpp"

#include "experiments/deformers/deformer_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/process/child_process.hpp"
#include "experiments/settings/recorded_settings.hpp"
#include "experiments/settings/scene_values.hpp"
#include "experiments/studies/shared/posed_reference.hpp"
#include "experiments/studies/study.hpp"
#include "pbs/character/body_cache.hpp"
#include "pbs/geometry/files.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/solver/options.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

namespace experiments {

void from_json(const nlohmann::json& keys, GridValue& value)
{
    const std::string of_young = "young_factor=";
    for (const std::string key : keys)
        if (key.starts_with(of_young))
            value.young_factor = std::stod(key.substr(of_young.size()));
        else
            value.keys.push_back(key);
}

namespace {

// Reads the entries of cases.toml. A key that an entry lacks has the value of `base`.
std::vector<ComparedDeformer> entries_of(const std::string& table, const ComparedDeformer& base)
{
    std::vector<ComparedDeformer> entries;
    const nlohmann::json document = cases_document("work_precision");
    for (nlohmann::json one : document.at(table)) {
        for (const nlohmann::json& ladder : document.at("ladder"))
            if (ladder.at("name") == one.value("ladder", ""))
                one.update({{"iterations", ladder.at("iterations")}, {"few", ladder.at("few")}});
        one.erase("ladder");
        ComparedDeformer& entry = entries.emplace_back(base);
        const auto read = [&](const char* key, auto& value) {
            if (one.contains(key)) one.at(key).get_to(value);
            one.erase(key);
        };
        read("name", entry.name), read("kind", entry.kind), read("group", entry.group), read("weights", entry.weights);
        read("class", entry.of_class), read("knows", entry.knows);
        read("fixed", entry.fixed), read("iterations_key", entry.iterations_key), read("iterations", entry.iterations);
        read("few", entry.few_iterations), read("grid", entry.grid), read("codes", entry.codes), read("young_key", entry.young_key);
        read("poisson_key", entry.poisson_key), read("smooth_weights", entry.smooth_weights);
        read("k_by_edge_length", entry.k_by_edge_length);
        if (!one.empty()) throw std::logic_error("work_precision/cases.toml: nothing reads " + one.dump() + " of " + entry.name);
    }
    return entries;
}

const std::string& text_of_scene(const Scene& scene)
{
    for (const BuiltInScene& built_in : built_in_scenes())
        if (built_in.name == scene.name) return built_in.text;
    throw std::logic_error("deformers are compared in built-in scenes, not in " + scene.name);
}

bool exist(const KeyValues& keys)
{
    const SceneSchema schema = scene_schema();
    return std::ranges::all_of(keys, [&](const std::string& key) { return schema.find(key.substr(0, key.find('='))) != nullptr; });
}

std::string assigned(const std::string& key, double value)
{
    return fmt::format("{}={:.17g}", key, value);
}

// The names of the reference's row, of the front of all deformers and of classes are taken too.
bool is_taken(const std::string& name)
{
    if (name == "reference" || name == "all" || name == "classes") return true;
    return std::ranges::any_of(deformer_groups(), [&](const DeformerGroup& group) {
        return group.key == name || group.of_class == name || std::ranges::find(group.deformers, name) != group.deformers.end();
    });
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
    if (is_taken(spec.name)) values.refuse(table + ".name", "expected a name that no deformer, group or row of the comparison has");
    const auto& options = options_of<ExternalOptions>(spec);
    const bool is_command = options.library.empty();
    const std::string why_not = is_command ? why_not_startable(options.command.front()) : why_not_loadable(options.library);
    if (why_not.empty()) return;
    values.refuse(table + (is_command ? ".command" : ".library"), (is_command ? "cannot be started: " : "") + why_not);
}

constexpr std::size_t grid_in_short = 3;
const std::string finite_elements = "finite_elements";

// Finite elements with the reference's material and attachment.
DeformerSpec fem_spec(const Scene& scene, reference_fem::Model model, int element_order)
{
    DeformerSpec spec = reference_flesh(scene);
    spec.name = spec.label = fmt::format("{}_p{}", name_of(model), element_order);
    auto& options = options_of<FemOptions>(spec);
    options.model = model;
    options.element_order = element_order;
    options.contact = model != reference_fem::Model::stable_neo_hookean;  // which is the limit of deformers without contact
    options.nested_start = element_order == 2 && model != reference_fem::Model::linear;
    return spec;
}

class SettingList {
public:
    SettingList(const Scene& scene, const SettingRange& range) : scene_(scene), range_(range) {}

    // The whole ladder with each value of the grid on the case's own mesh, and a part of it with the default value on the other meshes. A
    // change to PBS is measured on the case's own mesh alone.
    void add(const ComparedDeformer& entry, bool is_change)
    {
        const std::size_t first = settings.size();
        std::vector<GridValue> grid = grid_of(entry);
        if (range_.in_short) grid.resize(std::min(grid.size(), grid_in_short));
        for (const KeyValues& code : codes_of(entry)) {
            for (const GridValue& value : grid)
                add_ladder(entry, range_.in_short ? entry.few_iterations : entry.iterations, {{}, value, code}, 0);
            if (is_change) continue;
            for (const std::vector<int>* sizes : {&range_.other_vertices, &range_.without_fem})
                for (const int vertices : *sizes) add_ladder(entry, entry.few_iterations, {{}, grid.front(), code}, vertices);
        }
        for (std::size_t i = first; is_change && i < settings.size(); ++i) settings[i].change = &entry;
    }

    void add_fem()
    {
        using reference_fem::Model;
        for (const Model model : {Model::linear, Model::corotational, Model::neo_hookean})
            for (const int element_order : {1, 2})
                if (element_order == 1 || (range_.quadratic && model != Model::corotational)) add_fem(model, element_order, 0);
        add_fem(Model::stable_neo_hookean, 1, 0);  // the limit of the deformers that minimise an energy
        for (const int vertices : range_.other_vertices)
            for (const Model model : {Model::linear, Model::neo_hookean})
                for (const int element_order : {1, 2})
                    if (element_order == 1 || (range_.quadratic && model == Model::neo_hookean && vertices <= range_.quadratic_up_to))
                        add_fem(model, element_order, vertices);
        if (!range_.refined) return;
        Setting setting{"fem_neo_hookean", fem_spec(scene_, Model::neo_hookean, 1)};
        setting.refined = options_of<FemOptions>(setting.spec).nested_start = true;
        settings.push_back(setting);
    }

    std::vector<Setting> settings;

private:
    void add_ladder(const ComparedDeformer& entry, const std::vector<int>& iterations, SettingChoice choice, int vertices)
    {
        std::vector<std::optional<int>> counts(iterations.begin(), iterations.end());
        if (counts.empty()) counts.emplace_back();
        for (const std::optional<int> count : counts) {
            choice.iterations = count;
            settings.push_back({entry.name, spec_with(entry, scene_, choice), count, name_of(choice.value), vertices});
        }
    }

    void add_fem(reference_fem::Model model, int element_order, int vertices)
    {
        Setting setting{"fem_" + name_of(model), fem_spec(scene_, model, element_order)};
        setting.vertices = vertices;
        settings.push_back(setting);
    }

    const Scene& scene_;
    const SettingRange& range_;
};

}  // namespace

const std::vector<ComparedDeformer>& compared_deformers()
{
    static const std::vector<ComparedDeformer> entries = entries_of("deformer", {});
    return entries;
}

// They are measured in the packed code of PBS.
const std::vector<ComparedDeformer>& changes_to_pbs()
{
    static const std::vector<ComparedDeformer> entries =
        entries_of("change", {.kind = "pbs", .iterations_key = "pbs.iterations", .codes = {{"pbs.order=ordered", "pbs.precision=f32"}}});
    return entries;
}

bool is_available(const ComparedDeformer& entry)
{
    KeyValues keys = entry.fixed;
    if (!entry.iterations_key.empty()) keys.push_back(entry.iterations_key);
    return find_deformer_kind(entry.kind) && exist(keys);
}

std::vector<GridValue> grid_of(const ComparedDeformer& entry)
{
    std::vector<GridValue> grid = entry.grid;
    std::erase_if(grid, [](const GridValue& value) { return !exist(value.keys); });
    return grid;
}

std::vector<KeyValues> codes_of(const ComparedDeformer& entry)
{
    std::vector<KeyValues> codes = entry.codes;
    std::erase_if(codes, [](const KeyValues& code) { return !exist(code); });
    return codes.empty() ? std::vector<KeyValues>{{}} : codes;
}

DeformerSpec spec_with(const ComparedDeformer& entry, const Scene& scene, const SettingChoice& choice)
{
    const DeformerSpec reference = reference_flesh(scene);
    const auto& flesh = options_of<FemOptions>(reference);
    KeyValues keys = entry.fixed;
    for (const KeyValues& more : {choice.code, choice.value.keys}) keys.insert(keys.end(), more.begin(), more.end());
    if (choice.iterations) keys.push_back(fmt::format("{}={}", entry.iterations_key, *choice.iterations));
    if (!entry.young_key.empty()) keys.push_back(assigned(entry.young_key, choice.value.young_factor * flesh.young_pa));
    if (!entry.poisson_key.empty()) keys.push_back(assigned(entry.poisson_key, flesh.poisson));
    std::string text = text_of_scene(scene);
    if (!entry.weights.empty()) text += fmt::format("\n[[{}]]\nname = \"{}\"\nweights = \"{}\"\n", entry.kind, entry.name, entry.weights);
    const SceneValues values(text, scene.file, keys, scene_schema());
    DeformerSpec spec = default_spec(entry.kind);
    spec.name = spec.label = entry.name;
    const std::string table = entry.weights.empty() ? entry.kind : fmt::format("{}.{}", entry.kind, values.tables(entry.kind) - 1);
    const DeformerKind& kind = *find_deformer_kind(entry.kind);
    if (kind.read) kind.read(values, table, spec);
    spec.threads = 1;
    return spec;
}

std::string name_of(const GridValue& value)
{
    std::string name;
    const auto add = [&](const std::string& part) { name += (name.empty() ? "" : "+") + part; };
    for (std::string key : value.keys) {
        const std::size_t equals = key.find('='), dot = key.rfind('.', equals);
        key[equals] = '_';
        add(key.substr(dot + 1));
    }
    if (value.young_factor != 1.0) add(fmt::format("stiffness_factor_{:g}", value.young_factor));
    return name;
}

const std::vector<DeformerGroup>& deformer_groups()
{
    static const std::vector<DeformerGroup> groups = [] {
        std::vector<DeformerGroup> all;
        for (const ComparedDeformer& entry : compared_deformers()) {
            const std::string& key = entry.group.empty() ? entry.name : entry.group;
            auto found = std::ranges::find(all, key, &DeformerGroup::key);
            if (found == all.end()) found = all.insert(all.end(), DeformerGroup{.key = key, .of_class = entry.of_class});
            found->deformers.push_back(entry.name);
        }
        all.push_back({"linear_fem", {"fem_linear"}, false, finite_elements});
        all.push_back({"nonlinear_fem", {"fem_corotational", "fem_neo_hookean", "fem_stable_neo_hookean"}, false, finite_elements});
        return all;
    }();
    return groups;
}

std::vector<DeformerGroup> groups_with(const std::vector<std::string>& external)
{
    std::vector<DeformerGroup> all = deformer_groups();
    for (const std::string& name : external) all.push_back({name, {name}, true, name});
    return all;
}

std::vector<DeformerGroup> classes_of(const std::vector<DeformerGroup>& groups)
{
    std::vector<DeformerGroup> classes;
    for (const DeformerGroup& group : groups) {
        auto found = std::ranges::find(classes, group.of_class, &DeformerGroup::key);
        if (found == classes.end()) found = classes.insert(classes.end(), DeformerGroup{.key = group.of_class});
        found->deformers.insert(found->deformers.end(), group.deformers.begin(), group.deformers.end());
    }
    return classes;
}

std::vector<DeformerSpec> external_entries(const std::string& file)
{
    std::error_code code;
    if (!std::filesystem::is_regular_file(file, code))
        throw pbs::InputError(file, 0, "", "", "cannot be read: expected a file with schema = 1 and [[external]] tables");
    const std::string own = external_kind().name;
    const SceneValues values(pbs::read_text_file(file), file, {}, scene_schema());
    for (const SceneKey& key : scene_schema().keys) {
        const std::string table = key.in_list ? key.table + ".0" : key.table;
        if (key.table != own && values.has_table(table)) values.refuse(table, "expected only [[" + own + "]] tables");
    }
    const std::vector<DeformerSpec> entries = listed_deformers(values);
    if (entries.empty()) throw pbs::InputError(file, 0, own, "", "missing: expected at least one [[" + own + "]] table");
    for (std::size_t i = 0; i < entries.size(); ++i) check_external(values, own + "." + std::to_string(i), entries[i]);
    return entries;
}

SettingKey key_of(const Setting& setting)
{
    const DeformerSpec& spec = setting.spec;
    const DeformerTraits traits = traits_of(spec);
    SettingKey key{.deformer = setting.deformer, .iterations = setting.iterations, .precision = traits.precision};
    if (setting.vertices > 0) key.wanted_vertices = setting.vertices;
    key.refined = setting.refined;
    key.tuned = setting.tuned;
    key.packed = traits.packed;
    const auto entry = std::ranges::find(compared_deformers(), setting.deformer, &ComparedDeformer::name);
    if (entry != compared_deformers().end()) key.knows = entry->knows;
    if (setting.is_external()) key.precision.clear();  // it is not known
    if (const auto* xpbd = options_if<pbs::XpbdOptions>(spec)) key.iterations = xpbd->iterations, key.substeps = xpbd->substeps;
    if (const auto* fem = options_if<FemOptions>(spec)) key.element_order = fem->element_order, key.knows = "material attachment";
    const auto* pbs = options_if<pbs::PbsOptions>(spec);
    if (!pbs) return key;
    key.k_stretch = pbs->k_stretch;
    key.order = name_of(pbs->order);
    key.substeps = 1;
    return key;
}

SettingKey without_grid_value(SettingKey key)
{
    key.k_stretch.reset();
    key.tuned.clear();
    return key;
}

const analysis::Columns<SettingKey>& setting_columns()
{
    static const analysis::Columns<SettingKey> columns =
        MEMBER_COLUMNS(SettingKey, iterations, k_stretch, order, precision, substeps, element_order, wanted_vertices, refined) +
        MEMBER_COLUMNS(SettingKey, tuned, packed).in_group("code");
    return columns;
}

const analysis::Columns<SettingKey>& point_key_columns()
{
    static const analysis::Columns<SettingKey> columns = MEMBER_COLUMNS(SettingKey, deformer, knows) + setting_columns();
    return columns;
}

std::string digest_of(const std::vector<Setting>& settings)
{
    nlohmann::json all = nlohmann::json::array();
    for (const Setting& setting : settings)
        all.push_back({setting.deformer, to_json(setting.spec), setting.tuned, setting.vertices, setting.refined});
    return pbs::content_hash(all.dump());
}

RECORD_SETTINGS(SettingRange, in_short, quadratic, other_vertices, without_fem, quadratic_up_to, refined, changes)

std::vector<Setting> settings_of(const Scene& scene, const SettingRange& range)
{
    SettingList list(scene, range);
    for (const ComparedDeformer& entry : compared_deformers())
        if (is_available(entry)) list.add(entry, false);
    list.add_fem();
    if (range.changes)
        for (const ComparedDeformer& entry : changes_to_pbs()) list.add(entry, true);
    return list.settings;
}

}  // namespace experiments

#include "experiments/studies/work_precision/compared_deformers.hpp"

#include "experiments/deformers/external/external_deformers.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/process/child_process.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/settings/scene_values.hpp"
#include "experiments/studies/shared/posed_reference.hpp"
#include "pbs/geometry/files.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

namespace experiments {
namespace {

const std::vector<int> of_projections = {1, 2, 4, 8, 16, 24, 48, 96, 192}, few_of_projections = {4, 24, 96};
const std::vector<int> of_minimisers = {1, 2, 4, 8, 12, 16, 24, 48, 96}, few_of_minimisers = {4, 12, 24};

KeyValues set(const std::string& kind, const std::string& key, const std::string& value)
{
    return {kind + "." + key + "=" + value};
}

std::vector<SettingChange> each_of(const std::string& key, const std::vector<std::string>& values)
{
    std::vector<SettingChange> grid = {{}};
    for (const std::string& value : values) grid.push_back({{key + "=" + value}});
    return grid;
}

// In the code of each precision.
std::vector<KeyValues> precisions_of(const std::string& kind)
{
    return {set(kind, "precision", "f32"), set(kind, "precision", "f64")};
}

std::vector<KeyValues> codes_of_blend(const std::string& kind)
{
    return {set(kind, "precision", "f32"), set(kind, "packed", "false")};
}

std::vector<ComparedDeformer> blending()
{
    std::vector<ComparedDeformer> entries;
    for (const char* kind : {"lbs", "dqs"})
        for (const char* weights : {"paper", "diffused"}) {
            const std::string name = std::string(kind) + (weights == std::string("diffused") ? "_diffused" : "");
            entries.push_back({.name = name, .kind = kind, .weights = weights, .codes = codes_of_blend(kind)});
        }
    return entries;
}

// Numbers of steps, and sizes of a step for the rotations (lambda) and the translations (kappa, of which alpha is the share).
std::vector<SettingChange> direct_settings()
{
    std::vector<SettingChange> grid = each_of("direct_delta_mush.iterations", {"5", "40", "80"});
    grid.push_back({{"direct_delta_mush.lambda=1", "direct_delta_mush.kappa=1", "direct_delta_mush.alpha=0.5"}});
    grid.push_back({{"direct_delta_mush.lambda=2", "direct_delta_mush.kappa=2", "direct_delta_mush.alpha=0"}});
    return grid;
}

// Direct delta mush smooths once for all poses, so that its iterations are a setting and no work of a frame.
std::vector<ComparedDeformer> mushing()
{
    const ComparedDeformer mush = {.kind = "delta_mush",
                                   .iterations_key = "delta_mush.iterations",
                                   .iterations = {0, 1, 2, 5, 10, 20, 50, 100, 200},
                                   .few_iterations = {2, 10, 50},
                                   .grid = each_of("delta_mush.step", {"0.25", "0.9"}),
                                   .codes = precisions_of("delta_mush")};
    const ComparedDeformer direct = {.kind = "direct_delta_mush", .grid = direct_settings(), .codes = precisions_of("direct_delta_mush")};
    std::vector<ComparedDeformer> entries;
    for (ComparedDeformer entry : {mush, direct}) {
        entry.name = entry.kind;
        entries.push_back(entry);
        entry.fixed = set(entry.kind, "weights", "diffused");
        entry.name += "_diffused";
        entries.push_back(entry);
    }
    return entries;
}

ComparedDeformer projecting(const std::string& kind, const std::string& table, const std::vector<SettingChange>& grid)
{
    return {.name = kind,
            .kind = kind,
            .iterations_key = table + ".iterations",
            .iterations = of_projections,
            .few_iterations = few_of_projections,
            .grid = grid};
}

std::vector<ComparedDeformer> projecting_ones()
{
    const std::string exponent = "pbs.variant.stiffness=exponent";
    ComparedDeformer pbs = projecting("pbs", "pbs",
                                      {{},
                                       {{"pbs.k_stretch=0.5"}},
                                       {{"pbs.k_stretch=0.9"}},
                                       {{"pbs.k_stretch=0.05"}},
                                       {{"pbs.k_bind=0.1"}},
                                       {{"pbs.k_bind=0.3"}},
                                       {{exponent}},
                                       {{"pbs.k_stretch=0.9", exponent}}});
    pbs.codes = {{"pbs.order=ordered", "pbs.precision=f32"}, {"pbs.order=plain", "pbs.precision=f64"}};
    std::vector<ComparedDeformer> entries = {pbs, projecting("pbs_author", "pbs_author", {{}})};
    for (const char* kind : {"xpbd", "xpbd_small_steps"}) {
        ComparedDeformer& xpbd = entries.emplace_back(projecting(kind, "pbs", {{}, {.young_factor = 4.0}, {.young_factor = 16.0}}));
        xpbd.group = "xpbd";
        xpbd.codes = {{"xpbd.order=ordered", "xpbd.precision=f32"}, {"xpbd.order=plain", "xpbd.precision=f64"}};
        xpbd.young_key = "xpbd.young_pa";
        xpbd.poisson_key = "xpbd.poisson";
    }
    return entries;
}

// Deformers with the reference's material, held by the reference's springs.
ComparedDeformer elastic(const std::string& kind, const std::vector<SettingChange>& grid)
{
    return {.name = kind,
            .kind = kind,
            .iterations_key = kind + ".iterations",
            .iterations = of_minimisers,
            .few_iterations = few_of_minimisers,
            .grid = grid,
            .codes = {set(kind, "packed", "true"), set(kind, "packed", "false")},
            .poisson_key = kind + ".poisson"};
}

std::vector<ComparedDeformer> elastic_ones()
{
    std::vector<SettingChange> of_vbd = each_of("vbd.omega", {"1", "1.5", "1.75"});
    of_vbd.push_back({{"vbd.acceleration=chebyshev", "vbd.omega=1", "vbd.rho=0.9"}});
    return {
        elastic("quasi_newton", {{}, {{"quasi_newton.volume_share=0.3"}}, {{"quasi_newton.volume_share=1"}}, {{"quasi_newton.start=lbs"}}}),
        elastic("vbd", of_vbd), elastic("xpbd_neo_hookean", each_of("xpbd_neo_hookean.time_step", {"0.4", "0.6"})),
        elastic("projective_dynamics", {{}})};
}

// A change to PBS in its packed code. The settings that the quick form takes come first.
ComparedDeformer change(const std::string& name, const KeyValues& fixed, const std::string& key = "",
                        const std::vector<std::string>& values = {})
{
    ComparedDeformer entry = projecting("pbs", "pbs", {{}});
    entry.name = name;
    entry.fixed = fixed;
    entry.iterations.pop_back();            // as many as the largest budget has
    entry.few_iterations = {1, 4, 24, 96};  // a change that takes longer than PBS is interpolated from one iteration on
    entry.codes = {{"pbs.order=ordered", "pbs.precision=f32"}};
    if (values.empty()) return entry;
    entry.grid = each_of(key, values);
    entry.grid.erase(entry.grid.begin());
    return entry;
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

SceneValues values_with(const ComparedDeformer& entry, const Scene& scene, const KeyValues& keys)
{
    std::string text = text_of_scene(scene);
    if (!entry.weights.empty()) text += fmt::format("\n[[{}]]\nname = \"{}\"\nweights = \"{}\"\n", entry.kind, entry.name, entry.weights);
    return SceneValues(text, scene.file, keys, scene_schema());
}

// The names of the reference's row and of the front of all deformers are taken too.
bool is_taken(const std::string& name)
{
    if (name == "reference" || name == "all") return true;
    return std::ranges::any_of(deformer_groups(), [&](const DeformerGroup& group) {
        return group.key == name || std::ranges::find(group.deformers, name) != group.deformers.end();
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

}  // namespace

const std::vector<ComparedDeformer>& compared_deformers()
{
    static const std::vector<ComparedDeformer> entries = [] {
        std::vector<ComparedDeformer> all = blending();
        for (const auto& more : {mushing(), projecting_ones(), elastic_ones()}) all.insert(all.end(), more.begin(), more.end());
        return all;
    }();
    return entries;
}

const std::vector<ComparedDeformer>& changes_to_pbs()
{
    static const std::vector<ComparedDeformer> entries = [] {
        const std::string improved = "pbs.improved.";
        std::vector<ComparedDeformer> all = {
            change("smooth_weights", {}),
            change("bind_to_blended_position", {improved + "bind_to=blended_position"}, "pbs.k_bind",
                   {"0.02", "0.1", "0.002", "0.005", "0.01", "0.05", "0.2"}),
            change("region_volumes", {improved + "volume_of=regions"}, improved + "region_tets", {"64", "256", "16", "1024"}),
            change("tet_and_region_volumes", {improved + "volume_of=tets_and_regions"}, improved + "region_tets",
                   {"64", "256", "16", "1024"}),
            change("k_by_edge_length", {}),
            change("another_order", {}, "pbs.order", {"grouped", "plain"}),
            change(control, {}, "pbs.k_stretch", {"0.5", "0.05", "0.1", "0.9"})};
        all[0].smooth_weights = all[4].k_by_edge_length = true;
        all[5].codes = {{"pbs.precision=f32"}};
        all[6].grid.insert(all[6].grid.begin() + 1, {{{"pbs.k_bind=0.5"}}, {{"pbs.k_bind=0.1"}}});
        return all;
    }();
    return entries;
}

bool is_available(const ComparedDeformer& entry)
{
    KeyValues keys = entry.fixed;
    if (!entry.iterations_key.empty()) keys.push_back(entry.iterations_key);
    return find_deformer_kind(entry.kind) && exist(keys);
}

std::vector<SettingChange> grid_of(const ComparedDeformer& entry)
{
    std::vector<SettingChange> grid = entry.grid;
    std::erase_if(grid, [](const SettingChange& change) { return !exist(change.keys); });
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
    for (const KeyValues& more : {choice.code, choice.change.keys}) keys.insert(keys.end(), more.begin(), more.end());
    if (choice.iterations) keys.push_back(fmt::format("{}={}", entry.iterations_key, *choice.iterations));
    if (!entry.young_key.empty()) keys.push_back(assigned(entry.young_key, choice.change.young_factor * flesh.young_pa));
    if (!entry.poisson_key.empty()) keys.push_back(assigned(entry.poisson_key, flesh.poisson));
    const SceneValues values = values_with(entry, scene, keys);
    DeformerSpec spec = default_spec(entry.kind);
    spec.name = spec.label = entry.name;
    const std::string table = entry.weights.empty() ? entry.kind : fmt::format("{}.{}", entry.kind, values.tables(entry.kind) - 1);
    const DeformerKind& kind = *find_deformer_kind(entry.kind);
    if (kind.read) kind.read(values, table, spec);
    spec.threads = 1;
    return spec;
}

std::string name_of(const SettingChange& change)
{
    std::string name;
    const auto add = [&](const std::string& part) { name += (name.empty() ? "" : "+") + part; };
    for (std::string key : change.keys) {
        const std::size_t equals = key.find('='), dot = key.rfind('.', equals);
        key[equals] = '_';
        add(key.substr(dot + 1));
    }
    if (change.young_factor != 1.0) add(fmt::format("stiffness_factor_{:g}", change.young_factor));
    return name;
}

const std::vector<DeformerGroup>& deformer_groups()
{
    static const std::vector<DeformerGroup> groups = [] {
        std::vector<DeformerGroup> all;
        for (const ComparedDeformer& entry : compared_deformers()) {
            const std::string& key = entry.group.empty() ? entry.name : entry.group;
            auto found = std::ranges::find(all, key, &DeformerGroup::key);
            if (found == all.end()) found = all.insert(all.end(), DeformerGroup{key, {}});
            found->deformers.push_back(entry.name);
        }
        all.push_back({"linear_fem", {"fem_linear"}});
        all.push_back({"nonlinear_fem", {"fem_corotational", "fem_neo_hookean", "fem_stable_neo_hookean"}});
        return all;
    }();
    return groups;
}

std::vector<DeformerGroup> groups_with(const std::vector<std::string>& external)
{
    std::vector<DeformerGroup> all = deformer_groups();
    for (const std::string& name : external) all.push_back({name, {name}, true});
    return all;
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

}  // namespace experiments

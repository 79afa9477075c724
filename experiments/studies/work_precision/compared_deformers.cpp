#include "experiments/studies/work_precision/compared_deformers.hpp"

#include "experiments/deformers/external/external_deformers.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/process/own_process.hpp"
#include "experiments/process/program_run.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/scene/scene_keys.hpp"
#include "experiments/settings/scene_values.hpp"
#include "experiments/studies/shared/posed_reference.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/text_file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

namespace experiments {
namespace {

const std::vector<int> of_projections = {1, 2, 4, 8, 16, 24, 48, 96, 192}, few_of_projections = {4, 24, 96};
const std::vector<int> of_minimisers = {1, 2, 4, 8, 12, 16, 24, 48, 96}, few_of_minimisers = {4, 12, 24};
const std::vector<SettingChange> of_stiffness = {{}, {.young_factor = 4.0}, {.young_factor = 16.0}};

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
    for (const auto& [kind, words] : {std::pair{"lbs", "LBS"}, {"dqs", "DQS"}})
        for (const char* weights : {"paper", "diffused"}) {
            const bool is_diffused = std::string(weights) == "diffused";
            const std::string name = std::string(kind) + (is_diffused ? "_diffused" : "");
            entries.push_back({.name = name,
                               .kind = kind,
                               .group = name,
                               .words = std::string(words) + (is_diffused ? " with diffused weights" : ""),
                               .weights = weights,
                               .codes = codes_of_blend(kind)});
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
    const ComparedDeformer mush = {.name = "delta_mush",
                                   .kind = "delta_mush",
                                   .group = "delta_mush",
                                   .words = "delta mush",
                                   .iterations_key = "delta_mush.iterations",
                                   .iterations = {0, 1, 2, 5, 10, 20, 50, 100, 200},
                                   .few_iterations = {2, 10, 50},
                                   .grid = each_of("delta_mush.step", {"0.25", "0.9"}),
                                   .codes = precisions_of("delta_mush")};
    const ComparedDeformer direct = {.name = "direct_delta_mush",
                                     .kind = "direct_delta_mush",
                                     .group = "direct_delta_mush",
                                     .words = "direct delta mush",
                                     .grid = direct_settings(),
                                     .codes = precisions_of("direct_delta_mush")};
    std::vector<ComparedDeformer> entries;
    for (ComparedDeformer entry : {mush, direct}) {
        entries.push_back(entry);
        entry.fixed = set(entry.kind, "weights", "diffused");
        entry.name = entry.group = entry.kind + "_diffused";
        entry.words += " with diffused weights";
        entries.push_back(entry);
    }
    return entries;
}

std::vector<ComparedDeformer> projecting()
{
    const std::string exponent = "pbs.variant.stiffness=exponent";
    std::vector<ComparedDeformer> entries;
    entries.push_back({.name = "pbs",
                       .kind = "pbs",
                       .group = "pbs",
                       .words = "PBS",
                       .iterations_key = "pbs.iterations",
                       .iterations = of_projections,
                       .few_iterations = few_of_projections,
                       .grid = {{},
                                {{"pbs.k_stretch=0.5"}},
                                {{"pbs.k_stretch=0.9"}},
                                {{"pbs.k_stretch=0.05"}},
                                {{"pbs.k_bind=0.1"}},
                                {{"pbs.k_bind=0.3"}},
                                {{exponent}},
                                {{"pbs.k_stretch=0.9", exponent}}},
                       .codes = {{"pbs.order=ordered", "pbs.precision=f32"}, {"pbs.order=plain", "pbs.precision=f64"}}});
    entries.push_back({.name = "pbs_author",
                       .kind = "pbs_author",
                       .group = "pbs_author",
                       .words = "the first author's later code",
                       .iterations_key = "pbs_author.iterations",
                       .iterations = of_projections,
                       .few_iterations = few_of_projections});
    for (const auto& [kind, words] : {std::pair{"xpbd", "XPBD"}, {"xpbd_small_steps", "XPBD"}})
        entries.push_back({.name = kind,
                           .kind = kind,
                           .group = "xpbd",
                           .words = words,
                           .iterations_key = "pbs.iterations",
                           .iterations = of_projections,
                           .few_iterations = few_of_projections,
                           .grid = of_stiffness,
                           .codes = {{"xpbd.order=ordered", "xpbd.precision=f32"}, {"xpbd.order=plain", "xpbd.precision=f64"}},
                           .young_key = "xpbd.young_pa",
                           .poisson_key = "xpbd.poisson"});
    return entries;
}

// Deformers with the reference's material, held by the reference's springs.
ComparedDeformer elastic(const std::string& kind, const std::string& words)
{
    return {.name = kind,
            .kind = kind,
            .group = kind,
            .words = words,
            .iterations_key = kind + ".iterations",
            .iterations = of_minimisers,
            .few_iterations = few_of_minimisers,
            .codes = {set(kind, "arithmetic", "packed_f32"), set(kind, "arithmetic", "plain_f64")},
            .poisson_key = kind + ".poisson"};
}

std::vector<ComparedDeformer> elastic_ones()
{
    ComparedDeformer quasi_newton = elastic("quasi_newton", "quasi-Newton");
    quasi_newton.grid = {{}, {{"quasi_newton.volume_share=0.3"}}, {{"quasi_newton.volume_share=1"}}, {{"quasi_newton.start=lbs"}}};
    ComparedDeformer vbd = elastic("vbd", "vertex block descent");
    vbd.grid = each_of("vbd.omega", {"1", "1.5", "1.75"});
    vbd.grid.push_back({{"vbd.acceleration=chebyshev", "vbd.omega=1", "vbd.rho=0.9"}});
    ComparedDeformer xpbd = elastic("xpbd_neo_hookean", "neo-Hookean XPBD");
    xpbd.grid = each_of("xpbd_neo_hookean.time_step", {"0.4", "0.6"});
    return {quasi_newton, vbd, xpbd, elastic("projective_dynamics", "projective dynamics")};
}

}  // namespace

const std::vector<ComparedDeformer>& compared_deformers()
{
    static const std::vector<ComparedDeformer> entries = [] {
        std::vector<ComparedDeformer> all = blending();
        for (const auto& more : {mushing(), projecting(), elastic_ones()}) all.insert(all.end(), more.begin(), more.end());
        return all;
    }();
    return entries;
}

// From an entry of the table of compared deformers to a deformer with its options.

namespace {

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

}  // namespace

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
        const auto add = [&](const std::string& key, const std::string& words, const std::string& deformer) {
            auto found = std::ranges::find(all, key, &DeformerGroup::key);
            if (found == all.end()) found = all.insert(all.end(), DeformerGroup{key, words, {}});
            found->deformers.push_back(deformer);
        };
        for (const ComparedDeformer& entry : compared_deformers()) add(entry.group, entry.words, entry.name);
        add("linear_fem", "linear FEM", "fem_linear");
        for (const char* law : {"fem_corotational", "fem_neo_hookean", "fem_stable_neo_hookean"})
            add("nonlinear_fem", "nonlinear FEM", law);
        return all;
    }();
    return groups;
}

std::vector<DeformerGroup> groups_with(const std::vector<std::string>& external)
{
    std::vector<DeformerGroup> all = deformer_groups();
    for (const std::string& name : external) all.push_back({name, name, {name}, true});
    return all;
}

const DeformerGroup& group_of(const std::string& deformer)
{
    for (const DeformerGroup& group : deformer_groups())
        if (std::count(group.deformers.begin(), group.deformers.end(), deformer)) return group;
    throw std::logic_error("a deformer of no group: " + deformer);
}

const DeformerGroup& group_named(const std::string& key)
{
    for (const DeformerGroup& group : deformer_groups())
        if (group.key == key) return group;
    throw std::logic_error("no group of deformers: " + key);
}

namespace {

namespace fs = std::filesystem;

std::string text_of_entries(const std::string& file)
{
    std::error_code code;
    if (!fs::is_regular_file(file, code))
        throw pbs::InputError(file, 0, "", "", "cannot be read: expected a file with schema = 1 and [[external]] tables");
    return pbs::read_text_file(file);
}

void refuse_other_tables(const SceneValues& values, const std::string& own)
{
    const std::string rule = "expected only [[" + own + "]] tables";
    for (const SceneKey& key : scene_schema().keys) {
        const std::string table = key.in_list ? key.table + ".0" : key.table;
        if (key.table != own && values.has_table(table)) values.refuse(table, rule);
    }
}

// The names of the reference's row and of the front of all deformers are taken too.
bool is_taken(const std::string& name)
{
    if (name == "reference" || name == "all") return true;
    return std::ranges::any_of(deformer_groups(), [&](const DeformerGroup& group) {
        return group.key == name || std::ranges::find(group.deformers, name) != group.deformers.end();
    });
}

// Returns why the library cannot be used, or an empty text if it can. It is loaded in another process, which it may end.
std::string why_not_loadable(const std::string& library)
{
    try {
        return in_own_process([&] { return nlohmann::json(why_library_not_usable(library)); }).get<std::string>();
    } catch (const std::runtime_error& error) {
        return std::string("cannot be loaded: ") + error.what();
    }
}

void check_entry(const SceneValues& values, const std::string& table, const DeformerSpec& spec)
{
    if (is_taken(spec.name)) values.refuse(table + ".name", "expected a name that no deformer, group or row of the comparison has");
    const auto& options = options_of<ExternalOptions>(spec);
    if (options.library.empty()) {
        const std::string why_not = why_not_startable(options.command.front());
        if (!why_not.empty()) values.refuse(table + ".command", "cannot be started: " + why_not);
    } else {
        const std::string why_not = why_not_loadable(options.library);
        if (!why_not.empty()) values.refuse(table + ".library", why_not);
    }
}

}  // namespace

std::vector<DeformerSpec> external_entries(const std::string& file)
{
    const std::string own = external_kind().name;
    const SceneValues values(text_of_entries(file), file, {}, scene_schema());
    refuse_other_tables(values, own);
    const std::vector<DeformerSpec> entries = listed_deformers(values);
    if (entries.empty()) throw pbs::InputError(file, 0, own, "", "missing: expected at least one [[" + own + "]] table");
    for (std::size_t i = 0; i < entries.size(); ++i) check_entry(values, own + "." + std::to_string(i), entries[i]);
    return entries;
}

}  // namespace experiments

#include "experiments/studies/work_precision/external_entries.hpp"

#include "experiments/deformers/external/external_deformers.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/process/child_process.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/settings/scene_values.hpp"
#include "experiments/studies/work_precision/deformer_groups.hpp"
#include "pbs/geometry/files.hpp"
#include "pbs/geometry/input_error.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

namespace experiments {
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

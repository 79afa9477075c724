#include "experiments/command_line/verbs.hpp"
#include "experiments/scene/scene_keys.hpp"

#include <nlohmann/json.hpp>

#include <sstream>

namespace experiments {
namespace {

using nlohmann::json;

std::vector<std::string> names_of(const CLI::Option& option)
{
    std::vector<std::string> names;
    for (const std::string& name : option.get_snames()) names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
    return names;
}

// The choices in the name of an option's type, where CLI11 writes TEXT:{one,other}.
std::vector<std::string> choices_in(const std::string& type)
{
    const std::size_t open = type.find('{'), close = type.rfind('}');
    std::vector<std::string> choices;
    if (open == std::string::npos || close == std::string::npos) return choices;
    std::istringstream inside(type.substr(open + 1, close - open - 1));
    for (std::string choice; std::getline(inside, choice, ',');) choices.push_back(choice);
    return choices;
}

json describe_option(const CLI::Option& option)
{
    const std::string type = option.get_type_name();
    const bool takes_a_value = option.get_items_expected_max() > 0;
    return {{"names", names_of(option)},           {"name", option.get_name(option.get_positional())},
            {"meaning", option.get_description()}, {"value", takes_a_value ? type.substr(0, type.find_first_of(":[ ")) : ""},
            {"choices", choices_in(type)},         {"repeated", option.get_items_expected_max() > 1},
            {"required", option.get_required()}};
}

json describe_options(const CLI::App& app)
{
    json options = json::array();
    for (const CLI::Option* option : app.get_options({}))
        if (!option->get_group().empty()) options.push_back(describe_option(*option));
    return options;
}

json describe_scene_keys()
{
    json keys = json::array();
    for (const SceneKey& key : scene_schema().keys)
        keys.push_back({{"table", key.table},
                        {"name", key.name},
                        {"meaning", key.meaning},
                        {"unit", key.unit},
                        {"rule", key.rule()},
                        {"default", key.default_json},
                        {"in_list", key.in_list}});
    return keys;
}

}  // namespace

std::string describe(const CLI::App& app)
{
    json verbs = json::array();
    for (const CLI::App* verb : app.get_subcommands(std::function<bool(const CLI::App*)>{}))
        if (!verb->get_group().empty())
            verbs.push_back({{"name", verb->get_name()}, {"meaning", verb->get_description()}, {"options", describe_options(*verb)}});
    const json all = {{"name", app.get_name()},
                      {"meaning", app.get_description()},
                      {"options", describe_options(app)},
                      {"verbs", verbs},
                      {"scene_keys", describe_scene_keys()}};
    return all.dump(1);
}

}  // namespace experiments

#include "analysis/records/report_table.hpp"
#include "analysis/records/toml_keys.hpp"
#include "experiments/command_line/verbs.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/process/terminal.hpp"
#include "experiments/reproduce/studies.hpp"
#include "experiments/run/metrics_table.hpp"
#include "experiments/scene/movements.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/studies/study.hpp"
#include "generated/pages_texts.hpp"
#include "generated/words_texts.hpp"
#include "pbs/geometry/input_error.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>
#include <functional>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>

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
    return {{"names", names_of(option)},
            {"name", option.get_name(option.get_positional())},
            {"meaning", option.get_description()},
            {"value", takes_a_value ? type.substr(0, type.find_first_of(":[ ")) : ""},
            {"choices", choices_in(type)},
            {"repeated", option.get_items_expected_max() > 1},
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

using Lines = std::vector<std::pair<std::string, std::string>>;  // name, meaning

// One line per entry, by two of its members.
template <typename Entry, typename Name, typename Meaning>
Lines lines_of(const std::vector<Entry>& entries, Name name, Meaning meaning)
{
    Lines lines;
    for (const Entry& entry : entries) lines.emplace_back(std::invoke(name, entry), std::invoke(meaning, entry));
    return lines;
}

// A term of the glossary, and under which other words texts use it.
struct Term {
    std::string name, sentence;
    std::vector<std::string> also = {};
};

const std::vector<Term>& terms()
{
    static const std::vector<Term> read = [] {
        const std::string file = "glossary.toml";
        const toml::table table = analysis::parse_toml(*words::by_name.at("glossary"), file);
        std::vector<Term> list;
        for (const auto& [name, value] : table) {
            list.push_back({std::string(name.str()), ""});
            analysis::TomlKeys keys(*value.as_table(), file, "term");
            keys.required("sentence", list.back().sentence);
            keys.optional("also", list.back().also);
        }
        return list;
    }();
    return read;
}

// The name as one word, as in the links to the glossary: "Poisson's ratio" is poissons-ratio.
std::string slug(const std::string& name)
{
    std::string text;
    for (const unsigned char letter : name)
        if (std::isalnum(letter) || letter == '_')
            text += static_cast<char>(std::tolower(letter));
        else if (letter == ' ' || letter == '-')
            text += '-';
    return text;
}

// The README.md of a study or a deformer, or the page of a claim. std::logic_error if the source tree lacks it.
const std::string& page_named(const std::string& name)
{
    const auto page = pages::by_name.find(name);
    if (page == pages::by_name.end()) throw std::logic_error(name + " has no page");
    return *page->second;
}

const std::map<std::string, std::function<Lines()>> kinds = {
    {"cases",
     [] {
         return Lines{
             {"sweep", "a joint turns by angle_deg in `frames` frames; frame 0 is the rest pose"},
             {"movements",
              "joints turn through their range of motion, one movement after the other, each from the rest pose"},
             {"clip", "motion capture (BVH, glTF, FBX), retargeted and resampled"}};
     }},
    {"movements", listed_movements},
    {"scenes", [] { return lines_of(built_in_scenes(), &BuiltInScene::name, &BuiltInScene::meaning); }},
    {"deformers", [] { return lines_of(deformer_kinds(), &DeformerKind::name, &DeformerKind::meaning); }},
    {"studies",
     [] {
         return lines_of(studies(), &Study::name,
                         [](const Study& study) { return analysis::first_paragraph(page_named(study.name)); });
     }},
    {"claims", [] { return lines_of(claims(), &analysis::Claim::id, &analysis::Claim::statement); }},
    {"metrics", [] { return lines_of(metric_texts(), &MetricText::name, &MetricText::meaning); }},
    {"terms", [] {
         return lines_of(
             terms(), [](const Term& term) { return slug(term.name); }, &Term::sentence);
     }}};

int list(const std::vector<std::string>& asked)
{
    for (const auto& [kind, lines] : kinds) {
        if (!asked.empty() && std::find(asked.begin(), asked.end(), kind) == asked.end()) continue;
        fmt::print("{}\n", kind);
        for (const auto& [name, meaning] : lines()) fmt::print("  {:<26} {}\n", name, meaning);
    }
    say_next("pbskin explain NAME");
    return exit_finished;
}

std::string text_of(const std::string& name)
{
    return analysis::plain_text(page_named(name), terminal_width());
}

// A label and its text, which is wrapped in a column of its own.
void line(const std::string& label, const std::string& text)
{
    constexpr std::size_t label_width = 8, least = 30;
    const std::size_t width = std::max(terminal_width(), label_width + 4 + least) - label_width - 4;
    if (!text.empty()) fmt::print("{}", analysis::side_by_side({{"", 0}, {label, label_width}, {text, width}}));
}

bool explain_key(const std::string& name)
{
    bool found = false;
    for (const auto& key : scene_schema().keys) {
        if (key.path() != name && key.name != name && key.table != name) continue;
        found = true;
        fmt::print("{} (scene key)\n", key.path());
        line("meaning", key.meaning);
        line("unit", key.unit);
        line("rule", key.rule());
        line("default", key.default_json.empty() ? "none: every scene must state it" : key.default_json);
    }
    return found;
}

// Capital letters do not matter, and a plural in -s is found, too.
bool explain_term(const std::string& name)
{
    const auto is_meant = [asked = slug(name)](const std::string& word) {
        return asked == slug(word) || asked == slug(word) + "s";
    };
    bool found = false;
    for (const Term& term : terms()) {
        if (!is_meant(term.name) && std::ranges::none_of(term.also, is_meant)) continue;
        found = true;
        fmt::print("{} (term)\n", term.name);
        line("meaning", term.sentence);
    }
    return found;
}

bool explain_metric(const std::string& name)
{
    const MetricText* text = find_metric(name);
    if (!text) return false;
    fmt::print("{} (metric)\n", text->name);
    line("meaning", text->meaning);
    line("formula", text->formula);
    line("", fmt::format("{}", fmt::join(text->symbols, "\n")));
    line("unit", text->unit);
    line("source", text->source);
    line("cost", text->cost);
    return true;
}

// A claim is found by its id or page, and by a quantity that decides it unless a metric has that name.
bool explain_claim(const std::string& name)
{
    std::set<std::string> found;
    for (const auto& claim : claims()) {
        const bool is_decided_by_it = std::ranges::count(claim.own.quantities, name) > 0 && !find_metric(name);
        if ((is_asked_for(claim, name) || is_decided_by_it) && found.insert(page_of(claim)).second)
            fmt::print("{}", text_of(page_of(claim)));
    }
    return !found.empty();
}

std::string extent_text(const Study& study, bool full)
{
    double cost_s = 0.0;
    const StudyPlan plan = study.plan(full);
    for (const StudyRun& run : plan.runs) cost_s += run.cost_s;
    return fmt::format("{} runs, {:.1f} minutes on one core", plan.runs.size(), cost_s / 60.0);
}

std::string part_text(Extent extent)
{
    return extent == Extent::none ? "no" : extent == Extent::quick ? "in its quick form" : "in its full form";
}

// The README of the study, and what it costs on this machine with the bodies that are installed.
bool explain_study(const std::string& name)
{
    const auto study = std::ranges::find(studies(), name, &Study::name);
    if (study == studies().end()) return false;
    fmt::print("{}\nCost on this machine\n\n", text_of(name));
    line("--quick", extent_text(*study, false));
    line("--full", extent_text(*study, true));
    line("part of",
         fmt::format("reproduce: {}\nreproduce --full: {}", part_text(study->sets.quick), part_text(study->sets.full)));
    return true;
}

bool explain_deformer_or_scene(const std::string& name)
{
    if (const DeformerKind* kind = find_deformer_kind(name)) {
        fmt::print("{} (deformer)\n", kind->name);
        line("meaning", kind->meaning);
        if (pages::by_name.contains(name)) fmt::print("\n{}\n", text_of(name));
        return true;
    }
    for (const auto& scene : built_in_scenes())
        if (scene.name == name) {
            fmt::print("{} (scene)\n  {}\n\n{}", scene.name, scene.meaning, scene.text);
            return true;
        }
    return false;
}

// The verbs that --help lists.
std::vector<const CLI::App*> verbs_of(const CLI::App& app)
{
    return app.get_subcommands([](const CLI::App* verb) { return !verb->get_group().empty(); });
}

// As --help prints it.
bool explain_verb(const CLI::App& app, const std::string& name)
{
    for (const CLI::App* verb : verbs_of(app))
        if (verb->get_name() == name) {
            fmt::print("{}", verb->help(app.get_name()));
            return true;
        }
    return false;
}

std::vector<std::string> known_names(const CLI::App& app)
{
    std::vector<std::string> names;
    for (const CLI::App* verb : verbs_of(app)) names.push_back(verb->get_name());
    for (const auto& key : scene_schema().keys) names.insert(names.end(), {key.path(), key.name});
    for (const auto& text : metric_texts()) names.push_back(text.name);
    for (const auto& claim : claims()) {
        names.insert(names.end(), {claim.id, page_of(claim)});
        names.insert(names.end(), claim.own.quantities.begin(), claim.own.quantities.end());
    }
    for (const auto& study : studies()) names.push_back(study.name);
    for (const auto& kind : deformer_kinds()) names.push_back(kind.name);
    for (const auto& scene : built_in_scenes()) names.push_back(scene.name);
    for (const Term& term : terms()) names.insert(names.end(), {term.name, slug(term.name)});
    return names;
}

int explain(const CLI::App& app, const std::string& name)
{
    bool found = explain_verb(app, name);
    for (const auto explain_one :
         {explain_term, explain_metric, explain_claim, explain_study, explain_deformer_or_scene, explain_key})
        found |= explain_one(name);
    if (!found)
        throw pbs::InputError("", 0, "explain", name,
                              "unknown name; the nearest known one is " + pbs::nearest_name(name, known_names(app)));
    return exit_finished;
}

}  // namespace

std::string describe(const CLI::App& app)
{
    json verbs = json::array();
    for (const CLI::App* verb : verbs_of(app))
        verbs.push_back(
            {{"name", verb->get_name()}, {"meaning", verb->get_description()}, {"options", describe_options(*verb)}});
    const json all = {{"name", app.get_name()},
                      {"meaning", app.get_description()},
                      {"options", describe_options(app)},
                      {"verbs", verbs},
                      {"scene_keys", describe_scene_keys()}};
    return all.dump(1);
}

// pbskin list [cases, scenes, movements, deformers, studies, claims, metrics, terms]: lists what the program knows.

void add_list_verb(CommandLine& line)
{
    auto asked = std::make_shared<std::vector<std::string>>();
    CLI::App* verb = line.add("list", "lists scenes, movements, deformers, studies, claims, metrics, terms",
                              "pbskin list scenes claims", [asked] { return list(*asked); });
    verb->add_option("kind", *asked, "which of them; by default all")
        ->check(CLI::IsMember({"cases", "scenes", "movements", "deformers", "studies", "claims", "metrics", "terms"}));
}

// pbskin explain NAME: prints what a term, metric, claim, scene key, study, deformer, scene or verb means.

void add_explain_verb(CommandLine& line)
{
    auto words = std::make_shared<std::vector<std::string>>();
    CLI::App* verb =
        line.add("explain", "explains a term, metric, claim, key, study, deformer, scene or verb", "pbskin explain C02",
                 [&app = line.app, words] { return explain(app, fmt::format("{}", fmt::join(*words, " "))); });
    verb->add_option("name", *words, "its name, e.g. PBS, volume_change_pct, C02, pbs.k_volume, measure")->required();
}

}  // namespace experiments

// pbskin list [cases, scenes, deformers, studies, claims, metrics]: lists what the program knows.
#include "analysis/records/report_table.hpp"
#include "experiments/command_line/verbs.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/run/metrics_table.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/studies/study.hpp"
#include "generated/pages_texts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>

namespace experiments {
namespace {

using Lines = std::vector<std::pair<std::string, std::string>>;  // name, meaning

// One line per entry, by two of its members.
template <typename Entry, typename Name, typename Meaning>
Lines lines_of(const std::vector<Entry>& entries, Name name, Meaning meaning)
{
    Lines lines;
    for (const Entry& entry : entries) lines.emplace_back(std::invoke(name, entry), std::invoke(meaning, entry));
    return lines;
}

std::string question_of(const Study& study)
{
    return analysis::first_paragraph(*pages::by_name.at(study.name));
}

const std::map<std::string, std::function<Lines()>> kinds = {
    {"cases",
     [] {
         return Lines{{"sweep", "a joint turns by angle_deg in `frames` frames; frame 0 is the rest pose"},
                      {"clip", "motion capture (BVH, glTF, FBX), retargeted and resampled"}};
     }},
    {"scenes", [] { return lines_of(built_in_scenes(), &BuiltInScene::name, &BuiltInScene::meaning); }},
    {"deformers", [] { return lines_of(deformer_kinds(), &DeformerKind::name, &DeformerKind::meaning); }},
    {"studies", [] { return lines_of(studies(), &Study::name, question_of); }},
    {"claims", [] { return lines_of(claims(), &analysis::Claim::id, &analysis::Claim::statement); }},
    {"metrics", [] { return lines_of(metric_texts(), &MetricText::name, &MetricText::meaning); }}};

int list(const std::vector<std::string>& asked)
{
    for (const auto& [kind, lines] : kinds) {
        if (!asked.empty() && std::find(asked.begin(), asked.end(), kind) == asked.end()) continue;
        fmt::print("{}\n", kind);
        for (const auto& [name, meaning] : lines()) fmt::print("  {:<26} {}\n", name, meaning);
    }
    return exit_finished;
}

}  // namespace

void add_list_verb(CLI::App& app, CommonOptions& common, VerbAction& action)
{
    CLI::App* verb = add_verb(app, common, "list", "lists the cases, scenes, deformers, studies, claims and metrics");
    auto asked = std::make_shared<std::vector<std::string>>();
    verb->add_option("kind", *asked, "which of them; by default all")
        ->check(CLI::IsMember({"cases", "scenes", "deformers", "studies", "claims", "metrics"}));
    verb->callback([&action, asked] { action = [asked] { return list(*asked); }; });
}

}  // namespace experiments

// pbskin list [cases, scenes, deformers, studies, claims, metrics]: what there is.
#include "experiments/studies/shared/program_claims.hpp"
#include "experiments/command_line/embedded_pages.hpp"
#include "experiments/command_line/plain_markdown.hpp"
#include "experiments/command_line/verbs.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/run/metrics_table.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/studies/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace experiments {
namespace {

using Lines = std::vector<std::pair<std::string, std::string>>;

Lines cases()
{
    return {{"sweep", "a joint turns by angle_deg in `frames` frames; frame 0 is the rest pose"},
            {"clip", "motion capture (BVH, glTF, FBX), retargeted and resampled"}};
}

Lines scene_lines()
{
    Lines lines;
    for (const auto& scene : built_in_scenes()) lines.emplace_back(scene.name, scene.meaning);
    return lines;
}

Lines deformers()
{
    Lines lines;
    for (const auto& kind : deformer_kinds()) lines.emplace_back(kind.name, kind.meaning);
    return lines;
}

Lines study_lines()
{
    Lines lines;
    for (const auto& study : studies()) lines.emplace_back(study.name, first_paragraph(page_of(study.name)));
    return lines;
}

Lines listed_claims()
{
    Lines lines;
    for (const auto& claim : claims()) lines.emplace_back(claim.id, claim.statement);
    return lines;
}

Lines metrics()
{
    Lines lines;
    for (const auto& text : metric_texts()) lines.emplace_back(text.name, text.meaning);
    return lines;
}

const std::map<std::string, Lines (*)()> kinds = {{"cases", cases},         {"scenes", scene_lines},   {"deformers", deformers},
                                                  {"studies", study_lines}, {"claims", listed_claims}, {"metrics", metrics}};

int list(const std::vector<std::string>& asked)
{
    for (const auto& [kind, lines_of] : kinds) {
        if (!asked.empty() && std::find(asked.begin(), asked.end(), kind) == asked.end()) continue;
        fmt::print("{}\n", kind);
        for (const auto& [name, meaning] : lines_of()) fmt::print("  {:<26} {}\n", name, meaning);
    }
    return exit_finished;
}

}  // namespace

void add_list_verb(CLI::App& app, CommonOptions& common, VerbAction& action)
{
    CLI::App* verb = add_verb(app, common, "list", "what there is: cases, scenes, deformers, studies, claims, metrics");
    auto asked = std::make_shared<std::vector<std::string>>();
    verb->add_option("kind", *asked, "which of them; all by default")
        ->check(CLI::IsMember({"cases", "scenes", "deformers", "studies", "claims", "metrics"}));
    verb->callback([&action, asked] { action = [asked] { return list(*asked); }; });
}

}  // namespace experiments

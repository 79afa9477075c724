#include "experiments/verdicts/reproduce.cpp"

#include "experiments/studies/study.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

namespace experiments {
namespace {

namespace fs = std::filesystem;

// A named study runs in the extent that is asked for; without names, each runs in the extent of the set.
Extent asked_for(const Study& study, const std::vector<std::string>& names, bool full)
{
    if (names.empty()) return full ? study.sets.full : study.sets.quick;
    if (!is_named(study, names)) return Extent::none;
    return full ? Extent::full : Extent::quick;
}

bool is_among(const std::string& name, const std::vector<std::string>& names)
{
    return std::ranges::find(names, name) != names.end();
}

void refuse_unknown_runs(const std::vector<std::string>& only, const std::vector<PlannedStudy>& planned)
{
    std::vector<std::string> known, listed;
    for (const PlannedStudy& of : planned) {
        std::vector<std::string> of_study;
        for (const StudyRun& run : of.plan.runs) of_study.push_back(run.name);
        known.insert(known.end(), of_study.begin(), of_study.end());
        listed.push_back(fmt::format("{} ({})", fmt::join(of_study, ", "), of.study->name));
    }
    for (const std::string& name : only)
        if (!is_among(name, known))
            throw pbs::InputError("", 0, "--only", name, fmt::format("no such run; expected one of {}", fmt::join(listed, "; ")));
}

// Deformers of the user's own need a study that compares them, and a run of it.
void refuse_unused(const std::string& external, const std::vector<PlannedStudy>& planned)
{
    if (std::ranges::any_of(planned, [](const PlannedStudy& one) { return one.study->plan_with != nullptr; })) return;
    std::vector<std::string> taking;
    for (const Study& study : studies())
        if (study.plan_with) taking.push_back(study.name);
    throw pbs::InputError(
        "", 0, "--external", external,
        fmt::format("expected a run of {} among the runs; this study compares deformers of your own", fmt::join(taking, ", ")));
}

void choose_runs(PlannedStudy& planned, const std::vector<std::string>& only, bool resume)
{
    for (const StudyRun& run : planned.plan.runs) {
        const bool is_chosen = only.empty() || is_among(run.name, only), may_be_kept = resume || !is_chosen;
        if (may_be_kept && is_finished(run, (fs::path(planned.folder) / run.name).string()))
            planned.kept.push_back(run);
        else
            (is_chosen ? planned.to_do : planned.absent).push_back(run);
    }
}

}  // namespace

void refuse_unknown(const std::vector<std::string>& names)
{
    std::vector<std::string> known;
    for (const auto& study : studies()) known.push_back(study.name);
    for (const auto& claim : claims()) known.push_back(claim.id);
    for (const auto& name : names)
        if (!is_among(name, known))
            throw pbs::InputError("", 0, "reproduce", name,
                                  "unknown claim or study; expected one of " + fmt::format("{}", fmt::join(known, ", ")));
}

bool is_named(const Study& study, const std::vector<std::string>& names)
{
    return std::any_of(names.begin(), names.end(), [&](const std::string& name) {
        const auto of_study = [&](const analysis::Claim& claim) { return claim.id == name && claim.study == study.name; };
        return name == study.name || std::any_of(claims().begin(), claims().end(), of_study);
    });
}

std::vector<PlannedStudy> plan_studies(const ReproduceArguments& arguments)
{
    if (arguments.external && arguments.external->empty()) throw pbs::InputError("", 0, "--external", "", "expected a file");
    std::vector<PlannedStudy> planned;
    for (const Study& study : studies()) {
        const Extent extent = asked_for(study, arguments.names, arguments.full);
        if (extent == Extent::none) continue;
        const bool full = extent == Extent::full, is_extended = study.plan_with && arguments.external;
        planned.push_back({&study, is_extended ? study.plan_with(full, *arguments.external) : study.plan(full),
                           (fs::path(arguments.folder) / study.name).string()});
        planned.back().plan.extent = extent;
    }
    refuse_unknown_runs(arguments.only, planned);
    const auto has_none = [&](const PlannedStudy& of) {
        return std::ranges::none_of(of.plan.runs, [&](const StudyRun& run) { return is_among(run.name, arguments.only); });
    };
    if (!arguments.only.empty()) std::erase_if(planned, has_none);
    if (arguments.external) refuse_unused(*arguments.external, planned);
    for (PlannedStudy& of : planned) choose_runs(of, arguments.only, arguments.resume);
    return planned;
}

}  // namespace experiments

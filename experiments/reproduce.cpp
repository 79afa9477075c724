#include "experiments/reproduce.hpp"

#include "analysis/atomic_file.hpp"
#include "analysis/claims_report.hpp"
#include "analysis/measurement.hpp"
#include "experiments/claims_text.hpp"
#include "experiments/exit_status.hpp"
#include "experiments/studies/study.hpp"
#include "experiments/studies/study_run.hpp"
#include "experiments/studies/worker_pool.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <numeric>

namespace experiments {
namespace {

namespace fs = std::filesystem;

bool asked_for(const Study& study, const std::vector<std::string>& names)
{
    const auto asks = [&](const std::string& name) {
        const auto of_study = [&](const analysis::Claim& claim) { return claim.id == name && claim.study == study.name; };
        return name == study.name || std::any_of(claims().begin(), claims().end(), of_study);
    };
    return names.empty() ? study.by_default : std::any_of(names.begin(), names.end(), asks);
}

void refuse_unknown(const std::vector<std::string>& names)
{
    std::vector<std::string> known;
    for (const auto& study : studies()) known.push_back(study.name);
    for (const auto& claim : claims()) known.push_back(claim.id);
    for (const auto& name : names)
        if (!std::count(known.begin(), known.end(), name))
            throw pbs::InputError("", 0, "reproduce", name,
                                  "unknown claim or study; expected one of " + fmt::format("{}", fmt::join(known, ", ")));
}

struct StudyOutcome {
    std::vector<std::string> folders;  // of runs that ended; a failed one is said and left out, so that its verdict cannot be computed
    bool broke_down = false;
};

StudyOutcome run_study(const std::vector<StudyRun>& runs, const std::string& study_folder, const ReproduceArguments& arguments)
{
    std::vector<PooledWork> work;
    StudyOutcome outcome;
    for (const StudyRun& run : runs) {
        const std::string folder = (fs::path(study_folder) / run.name).string();
        if (arguments.resume && is_finished(run, folder))
            outcome.folders.push_back(folder);
        else
            work.push_back({run.name, run.cost_s, [&run, folder] { return carry_out(run, folder); }});
    }
    const double cost_s =
        std::accumulate(work.begin(), work.end(), 0.0, [](double sum, const PooledWork& item) { return sum + item.cost_s; });
    spdlog::info("{} runs, {} kept from before; some {:.0f} s of one core", work.size(), outcome.folders.size(), cost_s);
    for (const PooledResult& result : run_in_pool(work, arguments.jobs)) {
        if (result.finished)
            outcome.folders.push_back((fs::path(study_folder) / result.name).string());
        else
            spdlog::error("pbskin: {}: {}", result.name, result.failure);
        if (!result.breakdown.empty()) spdlog::error("pbskin: {}: numerical breakdown: {}", result.name, result.breakdown);
        outcome.broke_down |= !result.breakdown.empty();
    }
    return outcome;
}

// Frames in which the reference intersects itself stand beside the figures (no deformer has contact), and those without a reference.
std::string frames_to_mark(const std::vector<std::string>& folders)
{
    std::string lines;
    for (const std::string& folder : folders) {
        const auto outcome = nlohmann::json::parse(analysis::read_text((fs::path(folder) / "run.json").string())).at("outcome");
        if (const int count = outcome.value("self_intersecting_reference_frames", 0); count > 0)
            lines += fmt::format("     {}: the reference intersects itself in {} of {} frames; their errors are marked\n",
                                 fs::path(folder).filename().string(), count, outcome.at("frames").get<int>());
        const auto none = nlohmann::json::object();
        for (const auto& [label, count] : outcome.value("frames_below_reference_error", none).items())
            lines += fmt::format("     {}: the error of {} at the joints is not above the reference's own in {} of {} frames\n",
                                 fs::path(folder).filename().string(), label, count.get<int>(), outcome.at("frames").get<int>());
        for (const auto& [label, frames] : outcome.value("not_converged", none).items())
            lines += fmt::format("     {}: {} did not converge in {} of {} frames\n", fs::path(folder).filename().string(), label,
                                 frames.size(), outcome.at("frames").get<int>());
    }
    return lines;
}

// What the claims of a study are judged from: the records of its scene runs, and figures in print.
analysis::Records records_of(const StudyPlan& plan, const std::vector<std::string>& folders, const std::string& root)
{
    analysis::Records records;
    records.left_out = plan.left_out;
    for (const StudyRun& run : plan.runs)
        if (!run.work) records.planned_scenes.push_back(run.scene.name);
    for (const auto& left_out : plan.left_out) records.planned_scenes.push_back(left_out.scene);
    for (const std::string& folder : folders) {
        if (const fs::path printed = fs::path(folder) / "printed.csv"; fs::exists(printed))
            for (auto& figure : analysis::printed_figures(printed.string())) records.printed.push_back(std::move(figure));
        if (const fs::path measured = fs::path(folder) / "measurements.csv"; fs::exists(measured))
            for (auto& measurement : analysis::measurements(measured.string())) {
                measurement.run = fs::path(folder).lexically_relative(root).string();
                records.measurements.push_back(std::move(measurement));
            }
        if (!fs::exists(fs::path(folder) / "metrics.csv")) continue;
        const auto metrics = analysis::read_csv((fs::path(folder) / "metrics.csv").string());
        for (auto& record : analysis::case_records(metrics, fs::path(folder).lexically_relative(root).string()))
            records.cases.push_back(std::move(record));
    }
    return records;
}

// The verdicts of all studies, into DIR/claims.json, DIR/claims.md and the terminal; whether each could be computed.
bool tell_verdicts(const std::vector<analysis::Verdict>& verdicts, const std::string& folder)
{
    analysis::write_text_atomically((fs::path(folder) / "claims.json").string(), analysis::claims_json(verdicts).dump(2) + "\n");
    analysis::write_text_atomically((fs::path(folder) / "claims.md").string(), analysis::claims_markdown(verdicts));
    fmt::print("{}", analysis::claims_table(verdicts, isatty(STDOUT_FILENO) && !std::getenv("NO_COLOR")));
    return std::none_of(verdicts.begin(), verdicts.end(),
                        [](const auto& verdict) { return verdict.kind == analysis::VerdictKind::not_computable; });
}

}  // namespace

int reproduce(const ReproduceArguments& arguments)
{
    refuse_unknown(arguments.names);
    std::vector<analysis::Verdict> verdicts;
    std::string beside;  // what stands below the table of claims
    bool broke_down = false, all_hold = true;
    for (const Study& study : studies()) {
        if (!asked_for(study, arguments.names)) continue;
        spdlog::info("study {}: {}", study.name, study.meaning);
        const StudyPlan plan = study.plan(arguments.full);
        for (const auto& left_out : plan.left_out) spdlog::warn("left out: {}: {}", left_out.scene, left_out.reason);
        const std::string folder = (fs::path(arguments.folder) / study.name).string();
        const StudyOutcome outcome = run_study(plan.runs, folder, arguments);
        broke_down |= outcome.broke_down;
        beside += frames_to_mark(outcome.folders);
        const analysis::Records records = records_of(plan, outcome.folders, arguments.folder);
        for (const auto& claim : claims())
            if (claim.study == study.name) verdicts.push_back(analysis::judge(claim, records));
        if (!study.conclude) continue;
        const StudyConclusion conclusion = study.conclude(folder, plan, outcome.folders);
        beside += conclusion.text;
        all_hold &= conclusion.holds;
    }
    const bool all_computed = verdicts.empty() || tell_verdicts(verdicts, arguments.folder);
    fmt::print("{}", beside);
    if (broke_down) return exit_breakdown;
    return all_computed && all_hold ? exit_finished : exit_bound;
}

}  // namespace experiments

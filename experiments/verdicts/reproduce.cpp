#include "experiments/verdicts/reproduce.hpp"

#include "analysis/claims_report.hpp"
#include "analysis/claims_table.hpp"
#include "analysis/records/atomic_file.hpp"
#include "analysis/records/folder_files.hpp"
#include "analysis/records/provenance.hpp"
#include "experiments/process/failure.hpp"
#include "experiments/process/terminal.hpp"
#include "experiments/process/worker_pool.hpp"
#include "experiments/studies/shared/program_claims.hpp"
#include "experiments/studies/study_costs.hpp"
#include "experiments/studies/study_run.hpp"
#include "experiments/verdicts/marked_frames.hpp"
#include "experiments/verdicts/planned_studies.hpp"
#include "experiments/verdicts/study_records.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <filesystem>
#include <numeric>

namespace experiments {
namespace {

namespace fs = std::filesystem;

struct StudyOutcome {
    FinishedRuns finished = {};  // without failed runs, which are reported and whose verdicts cannot be computed
    bool broke_down = false, failed = false, refused = false;
    StudyCosts costs;
};

void report_breakdown(const std::string& name, const std::string& breakdown, StudyOutcome& outcome)
{
    if (breakdown.empty()) return;
    spdlog::error("pbskin: {}: numerical breakdown: {}", name, breakdown);
    outcome.broke_down = true;
}

// The breakdown of a kept run has the same effect as that of a new run.
void report_kept_breakdowns(const PlannedStudy& planned, StudyOutcome& outcome)
{
    for (const StudyRun& run : planned.kept)
        report_breakdown(run.name, breakdown_on_record(run, (fs::path(planned.folder) / run.name).string()), outcome);
}

// Records of an earlier revision or of other settings must not remain next to those of the runs to do.
void remove_old_records(const PlannedStudy& planned)
{
    for (const auto& runs : {planned.to_do, planned.absent})
        for (const StudyRun& run : runs) analysis::remove_record(fs::path(planned.folder) / run.name / "run.json");
}

void report_runs(const PlannedStudy& planned)
{
    spdlog::info("{} runs to do, {} kept", planned.to_do.size(), planned.kept.size());
    std::vector<std::string> names;
    for (const StudyRun& run : planned.absent) names.push_back(run.name);
    if (names.empty()) return;
    spdlog::warn("left out by --only: {}; the tables do not contain these runs, and verdicts that need them cannot be computed",
                 fmt::join(names, ", "));
}

// then_s: expected wall time of the studies after this one [s].
StudyOutcome run_study(const PlannedStudy& planned, int jobs, double then_s)
{
    std::error_code error;
    fs::create_directories(planned.folder, error);
    if (error) throw pbs::InputError(planned.folder, 0, "", "", "the output folder cannot be made: " + error.message());
    analysis::remove_abandoned_files(planned.folder);
    remove_old_records(planned);
    write_study_plan(planned.folder, planned.plan);
    std::vector<PooledWork> work;
    for (const StudyRun& run : planned.to_do)
        work.push_back(
            {run.name, run.cost_s, [&run, folder = (fs::path(planned.folder) / run.name).string()] { return carry_out(run, folder); }});
    report_runs(planned);
    StudyOutcome outcome{.costs = StudyCosts(planned.folder)};
    report_kept_breakdowns(planned, outcome);
    for (const PooledResult& result : run_in_pool(work, planned.study->alone ? 1 : jobs, then_s)) {
        if (!result.finished) spdlog::error("pbskin: {}: {}", result.name, result.failure);
        report_breakdown(result.name, result.breakdown, outcome);
        outcome.failed |= !result.finished;
        outcome.refused |= result.refused;
        const auto run =
            std::find_if(planned.to_do.begin(), planned.to_do.end(), [&](const StudyRun& of) { return of.name == result.name; });
        if (result.finished) outcome.costs.add(result.name, run->cost_s, result.cpu_s);
    }
    outcome.costs.complete(planned.folder, planned.plan);
    outcome.costs.write();
    outcome.finished = finished_runs(planned.folder);
    return outcome;
}

std::vector<analysis::Verdict> verdicts_of(const Study& study, const std::string& folder, const std::string& root)
{
    std::vector<analysis::Verdict> verdicts;
    const analysis::Records records = read_study_records(folder, root);
    for (const auto& claim : claims())
        if (claim.study == study.name) verdicts.push_back(analysis::judge(claim, records));
    return verdicts;
}

// Writes the verdicts of all studies to DIR/claims.json, DIR/claims.md and the terminal. Returns whether all could be computed.
bool report_verdicts(std::vector<analysis::Verdict> verdicts, const std::string& folder)
{
    std::stable_sort(verdicts.begin(), verdicts.end(), [](const auto& one, const auto& other) { return one.claim.id < other.claim.id; });
    analysis::write_text_atomically((fs::path(folder) / "claims.json").string(),
                                    analysis::claims_json(verdicts, analysis::collect_provenance(1).git_revision).dump(2) + "\n");
    analysis::write_text_atomically((fs::path(folder) / "claims.md").string(), analysis::claims_markdown(verdicts));
    fmt::print("{}all values: {}\nreport: pbskin report {}\n", analysis::claims_table(verdicts, terminal_width(), terminal_has_colours()),
               (fs::path(folder) / "claims.json").string(), folder);
    return std::none_of(verdicts.begin(), verdicts.end(),
                        [](const auto& verdict) { return verdict.kind == analysis::VerdictKind::not_computable; });
}

}  // namespace

int reproduce(const ReproduceArguments& arguments)
{
    refuse_unknown(arguments.names);
    const std::vector<PlannedStudy> planned = plan_studies(arguments);
    std::vector<ExpectedCost> expected;
    for (const PlannedStudy& of : planned) expected.push_back(expected_cost(*of.study, of.to_do, arguments.jobs));
    if (arguments.cost_only) return fmt::print("{}", expected_cost_table(expected)), exit_finished;
    if (planned.size() > 1) spdlog::info("expected cost:\n{}", expected_cost_table(expected));

    analysis::remove_abandoned_files(arguments.folder, false);
    std::vector<analysis::Verdict> verdicts;
    std::vector<std::pair<std::string, StudyCosts>> costs;
    std::string conclusions;  // of the studies, and on frames that need attention
    bool broke_down = false, refused = false, all_hold = true;
    for (std::size_t i = 0; i < planned.size(); ++i) {
        const Study* study = planned[i].study;
        spdlog::info("study {}", study->name);
        for (const auto& left_out : planned[i].plan.left_out) spdlog::warn("left out: {}: {}", left_out.scene, left_out.reason);
        const double then_s = std::accumulate(expected.begin() + static_cast<std::ptrdiff_t>(i) + 1, expected.end(), 0.0,
                                              [](double sum, const ExpectedCost& cost) { return sum + cost.wall_s; });
        const StudyOutcome outcome = run_study(planned[i], arguments.jobs, then_s);
        costs.emplace_back(study->name, outcome.costs);
        broke_down |= outcome.broke_down;
        refused |= outcome.refused;
        all_hold &= !outcome.failed;
        conclusions += marked_frames(outcome.finished.folders);
        for (auto& verdict : verdicts_of(*study, planned[i].folder, arguments.folder)) verdicts.push_back(std::move(verdict));
        if (!study->conclude) continue;
        const StudyConclusion conclusion = study->conclude(outcome.finished);
        outcome.finished.write("conclusion.txt", conclusion.text);
        conclusions += conclusion.text;
        all_hold &= conclusion.holds;
    }
    spdlog::info("actual cost:\n{}", cost_table(costs));
    fmt::print("{}", conclusions);
    const bool all_computed = verdicts.empty() || report_verdicts(verdicts, arguments.folder);
    if (refused) return exit_input;
    if (broke_down) return exit_breakdown;
    return all_computed && all_hold ? exit_finished : exit_bound;
}

int judge_again(const ReproduceArguments& arguments)
{
    refuse_unknown(arguments.names);
    const OpenedRecords opened(arguments.folder);
    std::vector<analysis::Verdict> verdicts;
    for (const Study& study : studies()) {
        const std::string folder = (fs::path(opened.folder()) / study.name).string();
        if (!has_study_plan(folder) || !(arguments.names.empty() || is_named(study, arguments.names))) continue;
        for (auto& verdict : verdicts_of(study, folder, opened.folder())) verdicts.push_back(std::move(verdict));
    }
    if (verdicts.empty())
        throw pbs::InputError(arguments.folder, 0, "reproduce --judge", "",
                              "no records of a study in this folder: expected one that reproduce wrote");
    return report_verdicts(verdicts, arguments.folder) ? exit_finished : exit_bound;
}

}  // namespace experiments

#include "experiments/reproduce/reproduce.hpp"

#include "analysis/records/provenance.hpp"
#include "analysis/verdicts/sensitivity.hpp"
#include "analysis/verdicts/verdict.hpp"
#include "experiments/characters/bodies.hpp"
#include "experiments/process/child_process.hpp"
#include "experiments/process/terminal.hpp"
#include "experiments/reproduce/last_screen.hpp"
#include "experiments/reproduce/studies.hpp"
#include "experiments/run/run.hpp"
#include "experiments/studies/shared/kept_references.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <span>
#include <sstream>

namespace experiments {
namespace {

namespace fs = std::filesystem;

// A study that `pbskin reproduce` runs, and which of its runs it carries out.
struct PlannedStudy {
    const Study* study;
    StudyPlan plan;
    std::string folder;
    std::vector<StudyRun> to_do = {};
    std::vector<StudyRun> kept = {};    // those that are finished with the same settings and revision
    std::vector<StudyRun> absent = {};  // those that ReproduceArguments::only leaves out and that are not finished
};

// Whether the study or one of its claims is among these names.
bool is_named(const Study& study, const std::vector<std::string>& names)
{
    return std::any_of(names.begin(), names.end(), [&](const std::string& name) {
        const auto of_study = [&](const analysis::Claim& claim) {
            return is_asked_for(claim, name) && claim.study == study.name;
        };
        return name == study.name || std::any_of(claims().begin(), claims().end(), of_study);
    });
}

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
    for (const PlannedStudy& planned_study : planned) {
        std::vector<std::string> of_study;
        for (const StudyRun& run : planned_study.plan.runs) of_study.push_back(run.name);
        known.insert(known.end(), of_study.begin(), of_study.end());
        listed.push_back(fmt::format("{} ({})", fmt::join(of_study, ", "), planned_study.study->name));
    }
    for (const std::string& name : only)
        if (!is_among(name, known))
            throw pbs::InputError("", 0, "--only", name,
                                  fmt::format("no such run; expected one of {}", fmt::join(listed, "; ")));
}

// Deformers of the user's own need a study that compares them, and a run of it.
void refuse_unused(const std::string& external, const std::vector<PlannedStudy>& planned)
{
    if (std::ranges::any_of(
            planned, [](const PlannedStudy& planned_study) { return planned_study.study->plan_with != nullptr; }))
        return;
    std::vector<std::string> taking;
    for (const Study& study : studies())
        if (study.plan_with) taking.push_back(study.name);
    throw pbs::InputError("", 0, "--external", external,
                          fmt::format("expected a run of {} among the runs; this study compares deformers of your own",
                                      fmt::join(taking, ", ")));
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

// InputError for a name that is neither a claim nor a study.
void refuse_unknown(const std::vector<std::string>& names)
{
    std::vector<std::string> known;
    for (const auto& study : studies()) known.push_back(study.name);
    for (const auto& claim : claims()) known.push_back(claim.id);
    for (const auto& name : names)
        if (!is_among(name, known) &&
            std::ranges::none_of(claims(), [&](const auto& claim) { return is_asked_for(claim, name); }))
            throw pbs::InputError(
                "", 0, "reproduce", name,
                "unknown claim or study; expected one of " + fmt::format("{}", fmt::join(known, ", ")));
}

// Returns the studies that have a run to do, or all studies without ReproduceArguments::only. InputError for the name
// of a run that no study has, for deformers of the user's own without a study that compares them, and where
// Study::plan_with does.
std::vector<PlannedStudy> plan_studies(const ReproduceArguments& arguments)
{
    if (arguments.external && arguments.external->empty())
        throw pbs::InputError("", 0, "--external", "", "expected a file");
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
    const auto has_none = [&](const PlannedStudy& planned_study) {
        return std::ranges::none_of(planned_study.plan.runs,
                                    [&](const StudyRun& run) { return is_among(run.name, arguments.only); });
    };
    if (!arguments.only.empty()) std::erase_if(planned, has_none);
    if (arguments.external) refuse_unused(*arguments.external, planned);
    for (PlannedStudy& planned_study : planned) {
        if (arguments.records_only)
            std::erase_if(planned_study.plan.runs,
                          [&](const StudyRun& run) { return !is_among(run.name, arguments.only); });
        choose_runs(planned_study, arguments.only, arguments.resume);
    }
    return planned;
}

// The runs to do, one per line, for a workflow that starts a process for each. `alone`: it measures time, and nothing
// else may run on its machine. arguments: of `pbskin reproduce`, without the folder.
std::string plan_text(const std::vector<PlannedStudy>& planned, const std::optional<std::string>& external)
{
    std::vector<std::string> lines;
    for (const PlannedStudy& planned_study : planned) {
        const Study& study = *planned_study.study;
        std::vector<std::string> words = {study.name, "--records-only"};
        if (planned_study.plan.extent == Extent::full) words.emplace_back("--full");
        if (external && study.plan_with) words.insert(words.end(), {"--external", fs::absolute(*external).string()});
        for (const StudyRun& run : planned_study.to_do) {
            nlohmann::json line = {
                {"run", study.name + "/" + run.name}, {"cost_s", run.cost_s}, {"alone", study.alone}};
            line["arguments"] = words;
            line["arguments"].insert(line["arguments"].end(), {"--only", run.name});
            lines.push_back(line.dump());
        }
    }
    return fmt::format("[{}]\n", fmt::join(lines, ",\n "));
}

struct Outcome {
    bool broke_down = false, failed = false, refused = false;

    int status() const
    {
        return refused ? exit_input : broke_down ? exit_breakdown : failed ? exit_bound : exit_finished;
    }
};

void report_breakdown(const std::string& name, const std::string& breakdown, Outcome& outcome)
{
    if (breakdown.empty()) return;
    spdlog::error("pbskin: {}: numerical breakdown: {}", name, breakdown);
    outcome.broke_down = true;
}

void begin(const PlannedStudy& planned)
{
    analysis::make_output_folder(planned.folder);
    analysis::remove_abandoned_files(planned.folder);
    // Records of an earlier revision or of other settings must not remain next to those of the runs to do.
    for (const auto& runs : {planned.to_do, planned.absent})
        for (const StudyRun& run : runs) analysis::remove_record(fs::path(planned.folder) / run.name / "run.json");
    write_study_plan(planned.folder, planned.plan);
    const auto level = planned.kept.empty() ? spdlog::level::debug : spdlog::level::info;
    spdlog::log(level, "study {}: {} runs to do, {} kept", planned.study->name, planned.to_do.size(),
                planned.kept.size());
    std::vector<std::string> names;
    for (const StudyRun& run : planned.absent) names.push_back(run.name);
    if (names.empty()) return;
    spdlog::info(
        "excluded by --only: {}; the tables do not contain these runs, and verdicts that need them cannot be computed",
        fmt::join(names, ", "));
}

// results: of the runs to do, in their order. A failed run is reported, and verdicts that need it cannot be computed.
void report(const PlannedStudy& planned, std::span<const PooledResult> results, Outcome& outcome)
{
    for (const StudyRun& run : planned.kept)  // a kept breakdown has the same effect as that of a new run
        report_breakdown(run.name, breakdown_on_record(run, (fs::path(planned.folder) / run.name).string()), outcome);
    for (const PooledResult& result : results) {
        if (!result.finished) spdlog::error("pbskin: {}: {}", result.name, result.failure);
        report_breakdown(result.name, result.breakdown, outcome);
        outcome.failed |= !result.finished;
        outcome.refused |= result.refused;
    }
}

// The runs of all these studies share the cores, so that no core is idle while a study ends. then_s: expected wall time
// of the studies after these [s].
void run_together(const std::vector<const PlannedStudy*>& planned, int jobs, double then_s, Outcome& outcome)
{
    std::vector<PooledWork> work;
    for (const PlannedStudy* planned_study : planned)
        for (const StudyRun& run : planned_study->to_do)
            work.push_back({planned.size() > 1 ? planned_study->study->name + "/" + run.name : run.name, run.cost_s,
                            [&run, folder = (fs::path(planned_study->folder) / run.name).string()] {
                                return carry_out(run, folder);
                            }});
    const std::vector<PooledResult> results = run_in_pool(work, jobs, then_s);
    std::span<const PooledResult> left = results;
    for (const PlannedStudy* planned_study : planned) {
        report(*planned_study, left.first(planned_study->to_do.size()), outcome);
        left = left.subspan(planned_study->to_do.size());
    }
}

// First all studies that share the cores, then those that measure time, one after the other. Returns an exit status.
int run_all(const std::vector<PlannedStudy>& planned, int jobs)
{
    Outcome outcome;
    std::vector<const PlannedStudy*> sharing, alone;
    double then_s = 0.0;
    for (const PlannedStudy& planned_study : planned) {
        (planned_study.study->alone ? alone : sharing).push_back(&planned_study);
        if (planned_study.study->alone) then_s += expected_wall_s(*planned_study.study, planned_study.to_do, jobs);
    }
    run_together(sharing, jobs, then_s, outcome);
    for (const PlannedStudy* planned_study : alone) {
        then_s -= expected_wall_s(*planned_study->study, planned_study->to_do, jobs);
        run_together({planned_study}, 1, then_s, outcome);
    }
    return outcome.status();
}

std::vector<analysis::Verdict> verdicts_of(const Study& study, const std::string& folder, const std::string& root)
{
    std::vector<analysis::Verdict> verdicts;
    const analysis::Records records = read_study_records(folder, root);
    for (const auto& claim : claims()) {
        if (claim.study != study.name) continue;
        verdicts.push_back(analysis::judge(claim, records));
        verdicts.back().sensitivity = analysis::sensitivity(claim, records);
    }
    return verdicts;
}

bool all_computable(const std::vector<analysis::Verdict>& verdicts)
{
    return std::ranges::none_of(verdicts, [](const analysis::Verdict& verdict) {
        return verdict.kind == analysis::VerdictKind::not_computable;
    });
}

// Names each body that is not installed once, with the command that brings it.
void name_left_out(const std::vector<PlannedStudy>& planned)
{
    std::set<std::string> reasons;
    for (const PlannedStudy& planned_study : planned)
        for (const analysis::LeftOut& left_out : planned_study.plan.left_out)
            if (reasons.insert(left_out.reason).second) spdlog::info("excluded: {}", left_out.reason);
}

bool has_run_of(const std::vector<PlannedStudy>& planned, const std::string& body)
{
    const auto is_of_body = [&](const StudyRun& run) { return is_run_of(run.name, body); };
    return std::ranges::any_of(planned, [&](const PlannedStudy& planned_study) {
        return std::ranges::any_of(planned_study.to_do, is_of_body) ||
               std::ranges::any_of(planned_study.kept, is_of_body);
    });
}

// The bodies among the runs whose tets are not those of the record. Each is named once, with the reason.
std::vector<std::string> name_other_tets(const std::vector<PlannedStudy>& planned)
{
    std::vector<std::string> other_tets;
    for (const pbs::NamedBody& body : pbs::named_bodies()) try {
            if (pbs::body_is_installed(body.name) && has_run_of(planned, body.name)) require_kept_tets(body.name);
        } catch (const pbs::InputError& error) {
            other_tets.push_back(body.name);
            spdlog::info("neither the runs of {0} nor verdicts are compared with the record: {1}", body.name,
                         error.what());
        }
    const std::string cgal = run_provenance(1).libraries["CGAL"];
    if (cgal != cgal_of_the_record)
        spdlog::info("the tets{} are those of the record; CGAL {} of this system would make others than CGAL {}",
                     other_tets.empty() ? "" : " of all other bodies", cgal, cgal_of_the_record);
    return other_tets;
}

}  // namespace

int reproduce(const ReproduceArguments& arguments)
{
    refuse_unknown(arguments.names);
    const std::vector<PlannedStudy> planned = plan_studies(arguments);
    if (arguments.records_only) return run_all(planned, arguments.jobs);
    double wall_s = 0.0;
    for (const PlannedStudy& planned_study : planned)
        wall_s += expected_wall_s(*planned_study.study, planned_study.to_do, arguments.jobs);
    if (planned.size() > 1 || arguments.plan_only)
        spdlog::info("{} studies, about {:.0f} min", planned.size(), std::ceil(wall_s / 60.0));
    if (arguments.plan_only) {
        fmt::print("{}", plan_text(planned, arguments.external));
        return exit_finished;
    }
    name_left_out(planned);
    const std::vector<std::string> other_tets = name_other_tets(planned);

    analysis::make_output_folder(arguments.folder);
    analysis::remove_abandoned_files(arguments.folder, false);
    CollectedWarnings warnings(analysis::path_in(arguments.folder, "warnings.txt"));
    LastScreen screen{.folder = arguments.folder, .other_tets = other_tets, .full = arguments.full};
    for (const PlannedStudy& planned_study : planned) begin(planned_study);
    const int status = run_all(planned, arguments.jobs);
    bool all_hold = true;
    for (const PlannedStudy& planned_study : planned) {
        write_costs(planned_study.folder, planned_study.plan);
        const FinishedRuns finished = finished_runs(planned_study.folder);
        std::istringstream marked(marked_frames(finished.folders));
        for (std::string line; std::getline(marked >> std::ws, line);)
            warnings.add(planned_study.study->name + "/" + line);
        for (auto& verdict : verdicts_of(*planned_study.study, planned_study.folder, arguments.folder))
            screen.here.push_back(std::move(verdict));
        all_hold &= study_holds(*planned_study.study, finished);
        const bool has_own_deformers = planned_study.study->plan_with && arguments.external;  // which no record has
        if (!has_own_deformers) screen.studies.push_back(planned_study.study->name);
    }
    const bool repeats = show_last_screen(screen);
    fmt::print("{}", warnings.summary());
    fmt::print("next: pbskin report {}\n", arguments.folder);
    if (status != exit_finished) return status;
    return repeats && all_computable(screen.here) && all_hold ? exit_finished : exit_bound;
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
    std::ranges::stable_sort(verdicts, {}, [](const analysis::Verdict& verdict) { return verdict.claim.id; });
    write_verdicts(verdicts, arguments.folder);
    // of a run, beside which other verdicts stood
    analysis::remove_record(fs::path(arguments.folder) / "repeated.json");
    fmt::print("{}", analysis::claims_table(verdicts, terminal_width(), terminal_has_colours()));
    return all_computable(verdicts) ? exit_finished : exit_bound;
}

}  // namespace experiments

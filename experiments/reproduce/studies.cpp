#include "experiments/reproduce/studies.hpp"

#include "analysis/records/record_files.hpp"
#include "analysis/records/tables.hpp"
#include "experiments/process/machine.hpp"
#include "experiments/run/run.hpp"
#include "pbs/geometry/cost.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <sys/resource.h>

#include <algorithm>
#include <filesystem>
#include <optional>

namespace experiments {

namespace fs = std::filesystem;

const std::vector<Study>& studies()
{
    static const std::vector<Study> studies = {
        volume_study(),    audit_study(),   momentum_study(),     convergence_study(), stability_study(),
        artefacts_study(), jiggle_study(),  stiffness_study(),    setup_study(),       ambiguity_study(),
        frames_study(),    timing_study(),  verification_study(), references_study(),  work_precision_study(),
        ensemble_study(),  temporal_study()};
    return studies;
}

namespace {

// All that the result of the run depends on, with its key in run.json.
std::pair<std::string, nlohmann::json> identity(const StudyRun& run)
{
    if (run.work) return {"work", {{"name", run.name}, {"settings", run.settings}}};
    return {"scene", to_json(run.scene)};
}

// Of this process with all threads, and of the processes that it has waited for [s].
double cpu_with_children_s()
{
    rusage children = {};
    getrusage(RUSAGE_CHILDREN, &children);
    const auto seconds = [](const timeval& time) { return double(time.tv_sec) + 1e-6 * double(time.tv_usec); };
    return process_cpu_s() + seconds(children.ru_utime) + seconds(children.ru_stime);
}

std::string carry_out_work(const StudyRun& run, const std::string& folder)
{
    analysis::make_output_folder(folder);
    const fs::path record = fs::path(folder) / "run.json";
    analysis::remove_record(record);
    const pbs::Stopwatch stopwatch;
    const double cpu_start_s = cpu_with_children_s();
    const std::string breakdown = run.work(folder);

    const auto [key, value] = identity(run);
    nlohmann::json outcome = {
        {"finished", true}, {"breakdown", breakdown}, {"cpu_seconds", cpu_with_children_s() - cpu_start_s}};
    outcome.update(run_end(stopwatch.seconds()));
    const nlohmann::json json = {
        {"schema", run_schema}, {key, value}, {"provenance", run_provenance(1)}, {"outcome", outcome}};
    analysis::write_text_atomically(record.string(), analysis::record_text(json));
    return breakdown;
}

struct RunCost {
    std::string run;
    double expected_s = 0.0;
    std::optional<double> cpu_s, wall_s;
};

const analysis::Columns<RunCost> cost_columns =
    analysis::Columns<RunCost>{
        {"run", &RunCost::run}, {"expected_cpu_s", &RunCost::expected_s}, {"cpu_s", &RunCost::cpu_s}} +
    analysis::Columns<RunCost>{{"wall_s", &RunCost::wall_s}}.in_group("wall");

std::optional<double> number_at(const nlohmann::json& run, const char* pointer)
{
    const nlohmann::json::json_pointer place(pointer);
    return run.contains(place) && run.at(place).is_number() ? std::optional(run.at(place).get<double>()) : std::nullopt;
}

}  // namespace

bool is_finished(const StudyRun& run, const std::string& folder)
{
    const fs::path record = fs::path(folder) / "run.json";
    if (!fs::exists(record)) return false;
    const auto json = nlohmann::json::parse(analysis::read_text(record.string()), nullptr, false);
    const auto [key, value] = identity(run);
    if (!json.is_object() || json.value("schema", nlohmann::json()) != run_schema) return false;
    if (json.value(key, nlohmann::json()) != value) return false;
    const analysis::Provenance now = analysis::collect_provenance(1);
    const nlohmann::json then = json.value("provenance", nlohmann::json()), none;
    return then.is_object() && then.value("git_revision", none) == now.git_revision &&
           then.value("git_dirty", none) == now.git_dirty;
}

bool study_holds(const Study& study, const FinishedRuns& finished)
{
    return !study.conclude || (!finished.none() && study.conclude(finished));
}

std::string carry_out(const StudyRun& run, const std::string& folder)
{
    if (run.work) return carry_out_work(run, folder);
    const RunResult result = run_scene(run.scene, folder);
    for (const auto& line : result.lines) spdlog::debug("{}", line);
    return run.bad_frames_are_results ? result.breakdown : result.failure();
}

std::string breakdown_on_record(const StudyRun& run, const std::string& folder)
{
    return analysis::from_record((fs::path(folder) / "run.json").string(), [&](const nlohmann::json& json) {
        const nlohmann::json& outcome = json.at("outcome");
        const auto breakdown = outcome.at("breakdown").get<std::string>();
        const bool bad_frame_counts = !run.work && !run.bad_frames_are_results && breakdown.empty();
        return bad_frame_counts ? outcome.at("bad_frame").get<std::string>() : breakdown;
    });
}

void write_costs(const std::string& folder, const StudyPlan& plan)
{
    std::vector<RunCost> costs;
    for (const StudyRun& run : plan.runs) {
        const fs::path record = fs::path(folder) / run.name / "run.json";
        if (!fs::exists(record)) continue;
        const auto json = nlohmann::json::parse(analysis::read_text(record.string()), nullptr, false);
        const char* cpu_s = json.contains("cost") ? "/cost/cpu_seconds/total" : "/outcome/cpu_seconds";
        costs.push_back({run.name, run.cost_s, number_at(json, cpu_s), number_at(json, "/outcome/wall_s")});
    }
    table_of(cost_columns, costs).write((fs::path(folder) / "costs.csv").string());
}

double expected_wall_s(const Study& study, const std::vector<StudyRun>& runs, int jobs)
{
    double cpu_s = 0.0, longest_s = 0.0;
    for (const StudyRun& run : runs) {
        cpu_s += run.cost_s;
        longest_s = std::max(longest_s, run.cost_s);
    }
    return std::max(longest_s, cpu_s / (study.alone ? 1 : jobs));
}

}  // namespace experiments

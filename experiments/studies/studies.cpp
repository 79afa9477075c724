#include "experiments/studies/study.hpp"

#include "analysis/records/record_files.hpp"
#include "experiments/process/machine.hpp"
#include "experiments/run/run.hpp"
#include "generated/claims_texts.hpp"
#include "pbs/geometry/cost.hpp"
#include "pbs/geometry/input_error.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

namespace experiments {

namespace fs = std::filesystem;

const std::vector<Study>& studies()
{
    static const std::vector<Study> all = {volume_study(),       audit_study(),     momentum_study(),       convergence_study(),
                                           stability_study(),    artefacts_study(), jiggle_study(),         stiffness_study(),
                                           setup_study(),        ambiguity_study(), frames_study(),         timing_study(),
                                           verification_study(), fit_study(),       work_precision_study(), ensemble_study()};
    return all;
}

namespace {

// All that the result of the run depends on, with its key in run.json.
std::pair<std::string, nlohmann::json> identity(const StudyRun& run)
{
    if (run.work) return {"work", {{"name", run.name}, {"settings", run.settings}}};
    return {"scene", to_json(run.scene)};
}

std::string carry_out_scene(const StudyRun& run, const std::string& folder)
{
    const RunResult result = run_scene(run.scene, folder);
    for (const auto& line : result.lines) spdlog::debug("{}", line);
    return run.bad_frames_are_results ? result.breakdown : result.failure();
}

std::string carry_out_work(const StudyRun& run, const std::string& folder)
{
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw pbs::InputError(folder, 0, "", "", "the output folder cannot be made: " + error.message());
    const fs::path record = fs::path(folder) / "run.json";
    analysis::remove_record(record);
    const pbs::Stopwatch stopwatch;
    const double cpu_start_s = process_cpu_s();
    const std::string breakdown = run.work(folder);

    const auto [key, value] = identity(run);
    nlohmann::json outcome = {{"finished", true}, {"breakdown", breakdown}, {"cpu_seconds", process_cpu_s() - cpu_start_s}};
    outcome.update(run_end(stopwatch.seconds()));
    const nlohmann::json json = {{"schema", run_schema}, {key, value}, {"provenance", run_provenance(1)}, {"outcome", outcome}};
    analysis::write_text_atomically(record.string(), analysis::record_text(json));
    return breakdown;
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
    return then.is_object() && then.value("git_revision", none) == now.git_revision && then.value("git_dirty", none) == now.git_dirty;
}

std::string carry_out(const StudyRun& run, const std::string& folder)
{
    return run.work ? carry_out_work(run, folder) : carry_out_scene(run, folder);
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

std::vector<std::string> FinishedRuns::files(const std::string& file) const
{
    std::vector<std::string> paths;
    for (const std::string& run : folders)
        if (const fs::path path = fs::path(run) / file; fs::exists(path)) paths.push_back(path.string());
    return paths;
}

analysis::CsvTable FinishedRuns::gathered(const std::string& file) const
{
    analysis::CsvTable all{{}};
    for (const std::string& path : files(file)) all.append(analysis::read_csv(path));
    return all;
}

void FinishedRuns::write(const std::string& file, const std::string& text) const
{
    analysis::write_text_atomically((fs::path(folder) / file).string(), text);
}

void FinishedRuns::write(const std::string& file, const analysis::CsvTable& table) const
{
    table.write((fs::path(folder) / file).string());
}

const std::vector<analysis::Claim>& claims()
{
    static const std::vector<analysis::Claim> all = analysis::parse_claims(::claims::claims_toml, "claims.toml");
    return all;
}

const analysis::Claim& claim_named(const std::string& id)
{
    const auto found = std::find_if(claims().begin(), claims().end(), [&](const analysis::Claim& claim) { return claim.id == id; });
    if (found == claims().end()) throw std::logic_error("no claim " + id);
    return *found;
}

std::vector<ReadingValues::LeftOut> all_but(const std::string& claim, const std::vector<std::string>& measured, const std::string& reason)
{
    std::vector<ReadingValues::LeftOut> left_out;
    for (const std::string& quantity : claim_named(claim).metrics)
        if (std::find(measured.begin(), measured.end(), quantity) == measured.end()) left_out.push_back({claim, quantity, reason});
    return left_out;
}

}  // namespace experiments

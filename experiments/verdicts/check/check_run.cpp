#include "experiments/verdicts/check/check_run.hpp"

#include "analysis/records/provenance.hpp"
#include "analysis/records/record_files.hpp"
#include "experiments/run/metrics_table.hpp"
#include "experiments/run/run.hpp"
#include "generated/claims_texts.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string_view>

namespace experiments {
namespace {

std::string_view environment(const char* name)
{
    const char* value = std::getenv(name);
    return value ? value : "";
}

std::string place_of(const analysis::CheckCase& check)
{
    if (check.file.empty()) return "";
    return check.line > 0 ? fmt::format("{}:{}: ", check.file, check.line) : check.file + ": ";
}

bool is_for_github(const CheckReports& reports)
{
    return reports.github || environment("GITHUB_ACTIONS") == "true";
}

// GitHub's file, to which each step of a job adds its summary.
void add_to_summary(const std::string& text)
{
    const std::string summary(environment("GITHUB_STEP_SUMMARY"));
    if (summary.empty()) return;
    std::ofstream file(summary, std::ios::app);
    if (!(file << text << std::flush))
        throw pbs::InputError(summary, 0, "GITHUB_STEP_SUMMARY", "", "cannot be written");
}

namespace fs = std::filesystem;
using analysis::CheckCase;
using analysis::CheckRules;
using analysis::CheckScene;
using analysis::CheckState;
using analysis::CheckSuite;
using analysis::CsvTable;

CheckRules rules_of(const CheckArguments& arguments)
{
    std::vector<std::string> metrics;
    for (const MetricText& metric : metric_texts())
        if (metric.name != "outcome" && !metric.is_of_measure_alone) metrics.push_back(metric.name);
    const CheckRules own =
        analysis::parse_check_rules(::claims::claims_toml, "experiments/verdicts/claims.toml", metrics);
    if (arguments.bounds.empty()) return own;
    CheckRules rules = analysis::parse_check_rules(analysis::read_text(arguments.bounds), arguments.bounds, metrics);
    if (rules.tolerances.empty()) rules.tolerances = own.tolerances;
    return rules;
}

struct Baseline {
    CsvTable table;
    std::string file;
};

std::optional<Baseline> baseline_of(const CheckArguments& arguments)
{
    if (!arguments.write_baseline.empty()) return std::nullopt;
    if (!arguments.baseline.empty()) return Baseline{analysis::read_csv(arguments.baseline), arguments.baseline};
    if (!arguments.bounds.empty()) return std::nullopt;
    const std::string own = "experiments/verdicts/check/check_baseline.csv";
    return Baseline{analysis::parse_csv(::claims::check_baseline_csv, own), own};
}

// A file in the folder of the user's bounds, or a built-in scene.
std::string file_or_name(const CheckScene& check, const std::string& bounds)
{
    const fs::path file = fs::path(bounds).parent_path() / check.scene;
    std::error_code error;
    return !bounds.empty() && fs::is_regular_file(file, error) ? file.string() : check.scene;
}

Scene scene_of(const CheckScene& check, const CheckRules& rules, const CheckArguments& arguments)
{
    try {
        Scene scene = read_scene(file_or_name(check, arguments.bounds), check.set);
        for (DeformerSpec& spec : scene.deformers) spec.threads = arguments.threads;
        return scene;
    } catch (const pbs::InputError& error) {
        throw pbs::InputError(rules.file, check.line, "scene", check.scene, error.what());
    }
}

CheckSuite suite_left_out(const CheckScene& check, const CheckRules& rules)
{
    CheckSuite suite{check.name, 0.0, {}, {}};
    suite.cases.push_back(
        {check.name, "runs", CheckState::left_out,
         fmt::format("left out with its bounds: {} is not installed; `pbskin run {}` states what it needs", check.needs,
                     check.scene),
         std::nullopt, std::nullopt, rules.file, check.line});
    return suite;
}

// Runs the scene and checks it. Adds its values to `measured`, and a breakdown to the result.
CheckSuite suite_of(const CheckScene& check, const CheckRules& rules, const CheckArguments& arguments,
                    const std::optional<Baseline>& baseline, CsvTable& measured, std::vector<std::string>& breakdowns)
{
    const std::string folder = (fs::path(arguments.folder) / check.name).string();
    const RunResult result = run_scene(scene_of(check, rules, arguments), folder);
    CheckSuite suite{check.name, result.seconds, {}, {}};
    const std::string& failure = result.failure();
    suite.cases.push_back({check.name, "runs", failure.empty() ? CheckState::held : CheckState::broke_down,
                           failure.empty() ? fmt::format("{} frames", result.frames) : failure, std::nullopt,
                           std::nullopt, rules.file, check.line, result.seconds});
    if (!failure.empty()) breakdowns.push_back(check.name + ": " + failure);
    const CsvTable metrics = analysis::read_csv((fs::path(folder) / "metrics.csv").string());
    for (const analysis::CheckBound& bound : rules.bounds)
        if (bound.scene == check.name) {
            const MetricText* metric = find_metric(bound.metric);
            suite.cases.push_back(judge_bound(bound, metric ? metric->unit : "", metrics, rules.file));
        }

    const auto [vertices, tets] =
        analysis::from_record((fs::path(folder) / "run.json").string(), [](const nlohmann::json& run) {
            return std::pair(run.at("character").at("vertices").get<int>(), run.at("character").at("tets").get<int>());
        });
    CsvTable now = analysis::baseline_columns(rules);
    analysis::add_baseline_rows(now, suite.name, metrics, vertices, tets);
    measured.append(now);
    if (baseline)
        for (CheckCase& of_baseline :
             analysis::compare_with_baseline(rules, suite.name, now, baseline->table, baseline->file))
            suite.cases.push_back(std::move(of_baseline));
    suite.properties = analysis::step_times(suite.name, now, baseline ? &baseline->table : nullptr);
    return suite;
}

nlohmann::json to_json(const CheckCase& check)
{
    nlohmann::json json = {{"name", check.name}, {"state", to_string(check.state)}, {"message", check.message}};
    if (check.frame) json["frame"] = *check.frame;
    if (check.value) json["value"] = *check.value;
    if (!check.file.empty()) json["file"] = check.file;
    if (check.line > 0) json["line"] = check.line;
    return json;
}

void write_record(const std::string& folder, const std::vector<CheckSuite>& suites, int threads)
{
    nlohmann::json record = {{"schema", 1}, {"provenance", analysis::collect_provenance(threads)}};
    for (const CheckState state : {CheckState::held, CheckState::failed, CheckState::left_out, CheckState::broke_down})
        record["outcome"][to_string(state)] = count(suites, state);
    for (const CheckSuite& suite : suites) {
        nlohmann::json& json = record["scenes"].emplace_back();
        json = {{"name", suite.name}, {"seconds", suite.seconds}, {"cases", nlohmann::json::array()}};
        for (const CheckCase& check : suite.cases) json["cases"].push_back(to_json(check));
        for (const auto& [name, value] : suite.properties) json["tracked"][name] = value;
    }
    analysis::write_text_atomically((fs::path(folder) / "check.json").string(), analysis::record_text(record));
}

bool is_left_out(const CheckScene& check)
{
    return !check.needs.empty() && !pbs::body_is_installed(check.needs);
}

void require_scenes(const CheckRules& rules, bool require_all)
{
    const bool none = std::all_of(rules.scenes.begin(), rules.scenes.end(), is_left_out);
    for (const CheckScene& check : rules.scenes)
        if (is_left_out(check) && (none || require_all)) pbs::require_body(check.needs);
}

}  // namespace

void report_failures(const std::vector<analysis::CheckSuite>& suites)
{
    for (const analysis::CheckSuite& suite : suites)
        for (const analysis::CheckCase& check : suite.cases) {
            const std::string line =
                fmt::format("pbskin: {}{}: {}: {}", place_of(check), suite.name, check.name, check.message);
            if (check.state == analysis::CheckState::left_out)
                spdlog::warn("{}", line);
            else if (check.state != analysis::CheckState::held)
                spdlog::error("{}", line);
        }
}

void require_writable(const CheckReports& reports)
{
    if (!reports.junit.empty()) analysis::require_writable(reports.junit);
    if (is_for_github(reports)) add_to_summary("");
}

void write_reports(const CheckReports& reports, const std::vector<analysis::CheckSuite>& suites)
{
    if (!reports.junit.empty()) analysis::write_text_atomically(reports.junit, analysis::junit_report(suites));
    if (!is_for_github(reports)) return;
    fmt::print("{}", analysis::github_annotations(suites));
    add_to_summary(analysis::github_summary(suites));
}

CheckResult run_check(const CheckArguments& arguments)
{
    const CheckRules rules = rules_of(arguments);
    const std::optional<Baseline> baseline = baseline_of(arguments);
    if (baseline) analysis::require_baseline(rules, baseline->table, baseline->file);
    require_scenes(rules, arguments.require_all);

    CsvTable measured = analysis::baseline_columns(rules);
    CheckResult result;
    for (const CheckScene& check : rules.scenes)
        result.suites.push_back(is_left_out(check)
                                    ? suite_left_out(check, rules)
                                    : suite_of(check, rules, arguments, baseline, measured, result.breakdowns));
    if (baseline)
        for (const CheckCase& gone : scenes_gone(rules, baseline->table, baseline->file))
            result.suites.push_back({gone.suite, 0.0, {}, {gone}});
    if (!arguments.write_baseline.empty()) measured.write(arguments.write_baseline);
    write_record(arguments.folder, result.suites, arguments.threads);
    return result;
}

}  // namespace experiments

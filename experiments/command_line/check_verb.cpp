// pbskin check [-o DIR] [--junit FILE] [--baseline FILE]: checks volume preservation and other bounds in continuous integration.
#include "analysis/records/record_files.hpp"
#include "experiments/command_line/verbs.hpp"
#include "experiments/process/progress.hpp"
#include "experiments/verdicts/check/check_reports.hpp"
#include "experiments/verdicts/check/check_run.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <filesystem>

namespace experiments {
namespace {

int check(CheckArguments arguments, const CheckReports& reports, const CommonOptions& common)
{
    if (common.quiet) hide_progress();
    arguments.threads = common.threads;
    std::error_code reported_by_the_run;
    if (!reports.junit.empty()) std::filesystem::create_directories(arguments.folder, reported_by_the_run);  // the report may go there
    require_writable(reports);
    if (!arguments.write_baseline.empty()) analysis::require_writable(arguments.write_baseline);
    const CheckResult result = run_check(arguments);
    if (!common.quiet) fmt::print("{}", analysis::check_table(result.suites));
    report_failures(result.suites);
    write_reports(reports, result.suites);
    const int held = count(result.suites, analysis::CheckState::held), failed = count(result.suites, analysis::CheckState::failed);
    spdlog::info("{} hold, {} fail, {} left out; records in {}", held, failed, count(result.suites, analysis::CheckState::left_out),
                 arguments.folder);
    if (!result.breakdowns.empty()) return exit_breakdown;
    return failed > 0 ? exit_bound : exit_finished;
}

}  // namespace

void add_check_verb(CLI::App& app, CommonOptions& common, VerbAction& action)
{
    CLI::App* verb =
        add_verb(app, common, "check",
                 "checks in continuous integration: runs small real scenes and compares volume preservation and other values with "
                 "bounds and a baseline; exit 1 if one does not hold");
    auto arguments = std::make_shared<CheckArguments>();
    auto reports = std::make_shared<CheckReports>();
    verb->add_option("-o,--output", arguments->folder, "folder of the records")->capture_default_str();
    verb->add_option(
        "--bounds", arguments->bounds,
        "your scenes and bounds: TOML with [[check.scene]], [[check.bound]], [[check.tolerance]]; by default those of the project");
    auto* baseline = verb->add_option("--baseline", arguments->baseline,
                                      "earlier values (CSV) to compare with: counts and accuracy decide, wall time is only shown");
    verb->add_option("--write-baseline", arguments->write_baseline, "write the values of this run there and compare with nothing")
        ->excludes(baseline);
    verb->add_flag("--require-all", arguments->require_all,
                   "exit 2 if the body of a scene is not installed, instead of leaving the scene out");
    verb->add_option("--junit", reports->junit, "write a JUnit report with one test case per bound");
    verb->add_flag("--github", reports->github, "annotations for GitHub on stdout (the default where GITHUB_ACTIONS is true)");
    verb->callback(
        [&action, &common, arguments, reports] { action = [&common, arguments, reports] { return check(*arguments, *reports, common); }; });
}

}  // namespace experiments

// pbskin check [-o DIR] [--junit FILE] [--baseline FILE]: CI validation, volume preservation and the other bounds.
#include "analysis/records/atomic_file.hpp"
#include "experiments/verdicts/check/check_reports.hpp"
#include "experiments/verdicts/check/check_run.hpp"
#include "experiments/command_line/verbs.hpp"
#include "experiments/process/progress.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <filesystem>

namespace experiments {
namespace {

int check(CheckArguments arguments, const CheckReports& reports, const CommonOptions& common)
{
    if (common.quiet) hide_progress();
    arguments.threads = common.threads;
    std::error_code told_by_the_run;
    if (!reports.junit.empty()) std::filesystem::create_directories(arguments.folder, told_by_the_run);  // a report may lie there
    require_writable(reports);
    if (!arguments.write_baseline.empty()) analysis::require_writable(arguments.write_baseline);
    const CheckResult result = run_check(arguments);
    if (!common.quiet) fmt::print("{}", analysis::check_table(result.suites));
    tell_failures(result.suites);
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
    CLI::App* verb = add_verb(app, common, "check",
                              "CI validation: runs small real scenes, holds volume preservation and other figures against bounds and a "
                              "baseline; exit 1 where one does not hold");
    auto arguments = std::make_shared<CheckArguments>();
    auto reports = std::make_shared<CheckReports>();
    verb->add_option("-o,--output", arguments->folder, "folder of the records")->capture_default_str();
    verb->add_option(
        "--bounds", arguments->bounds,
        "your scenes and bounds: TOML with [[check.scene]], [[check.bound]], [[check.tolerance]]; the project's own by default");
    auto* baseline = verb->add_option("--baseline", arguments->baseline,
                                      "earlier figures (CSV) to compare with: counts and accuracy are judged, wall time is only shown");
    verb->add_option("--write-baseline", arguments->write_baseline, "write this run's figures there, compare with none")
        ->excludes(baseline);
    verb->add_flag("--require-all", arguments->require_all, "exit 2 where a scene's body is not installed, instead of leaving it out");
    verb->add_option("--junit", reports->junit, "write a JUnit report, one test case a bound");
    verb->add_flag("--github", reports->github, "annotations for GitHub on stdout (by itself where GITHUB_ACTIONS is true)");
    verb->callback(
        [&action, &common, arguments, reports] { action = [&common, arguments, reports] { return check(*arguments, *reports, common); }; });
}

}  // namespace experiments

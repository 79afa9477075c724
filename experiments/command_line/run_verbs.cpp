// pbskin run SCENE.toml [-o DIR] [--set key=value]...: runs one scene and writes frames and records.

#include "analysis/records/record_files.hpp"
#include "experiments/command_line/verbs.hpp"
#include "experiments/process/terminal.hpp"
#include "experiments/run/run.hpp"
#include "experiments/studies/reproduce.hpp"
#include "experiments/studies/study.hpp"
#include "experiments/verdicts/check/check_run.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <filesystem>
#include <string>
#include <vector>

namespace experiments {
namespace {

struct RunArguments {
    std::string scene, folder;
    std::vector<std::string> overrides;
};

int run(const RunArguments& arguments, const CommonOptions& common)
{
    if (common.quiet) hide_progress();
    Scene scene = read_scene(arguments.scene, arguments.overrides);
    const std::string folder = arguments.folder.empty() ? "results/" + scene.name : arguments.folder;
    for (DeformerSpec& spec : scene.deformers) spec.threads = common.threads;
    const RunResult result = run_scene(scene, folder);
    for (const auto& line : result.lines) spdlog::info("{}", line);
    spdlog::info("{}: {} frames, {:.1f} s, records in {}", scene.name, result.frames, result.seconds, folder);
    if (!result.breakdown.empty()) spdlog::error("pbskin: numerical breakdown: {}", result.breakdown);
    if (!result.bad_frame.empty()) spdlog::error("pbskin: {}", result.bad_frame);
    return result.failure().empty() ? exit_finished : exit_breakdown;
}

}  // namespace

void add_run_verb(CLI::App& app, CommonOptions& common, VerbAction& action)
{
    CLI::App* verb = add_verb(app, common, "run", "runs one scene and writes frames and records");
    auto arguments = std::make_shared<RunArguments>();
    verb->add_option("scene", arguments->scene, "a scene file, or the name of a built-in scene")->required();
    verb->add_option("-o,--output", arguments->folder, "folder of the records; by default results/NAME");
    verb->add_option("--set", arguments->overrides, "key=value, e.g. pbs.iterations=96")->allow_extra_args(false);
    verb->callback([&action, &common, arguments] { action = [&common, arguments] { return run(*arguments, common); }; });
}

// pbskin reproduce [CLAIM or STUDY]... [-o DIR] [--quick, --full] [-j N] [--resume]
//                  [--external FILE] [--only RUN]...: runs studies and computes verdicts.

namespace {

std::string meaning_of_full()
{
    std::vector<std::string> in_part;
    for (const Study& study : studies())
        if (study.sets.full == Extent::quick) in_part.push_back(study.name);
    return fmt::format("the whole studies; without names, only a part of {}", fmt::join(in_part, ", "));
}

}  // namespace

void add_reproduce_verb(CLI::App& app, CommonOptions& common, VerbAction& action)
{
    CLI::App* verb = add_verb(app, common, "reproduce",
                              "runs studies, writes their records and computes verdicts; by default the studies of the quick set");
    auto arguments = std::make_shared<ReproduceArguments>();
    verb->add_option("names", arguments->names, "claims (C02) or studies (volume)");
    verb->add_option("-o,--output", arguments->folder, "folder of the records")->capture_default_str();
    auto* full = verb->add_flag("--full", arguments->full, meaning_of_full());
    auto quick = std::make_shared<bool>(false);
    verb->add_flag("--quick", *quick, "a part of each study that decides the same claims in minutes (default)")->excludes(full);
    verb->add_option("-j,--jobs", arguments->jobs, "number of runs in parallel")->check(CLI::Range(1, 256))->capture_default_str();
    auto* resume = verb->add_flag("--resume", arguments->resume, "keep the runs that are finished already");
    verb->add_flag("--cost", arguments->cost_only, "run nothing and print the expected time");
    auto* external = verb->add_option("--external", arguments->external,
                                      "a TOML file with [[external]] tables: deformers of your own for the study work_precision")
                         ->type_name("FILE");
    auto* only = verb->add_option("--only", arguments->only,
                                  "carries out this run alone, e.g. human_crouch, and keeps the others that are finished; may be given "
                                  "several times; by default all runs of the studies")
                     ->type_name("RUN")
                     ->expected(1)
                     ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    auto judge = std::make_shared<bool>(false);
    verb->add_flag("--judge", *judge, "run nothing and compute the verdicts from the records in the folder")
        ->excludes(full)
        ->excludes(resume)
        ->excludes(external)
        ->excludes(only);
    verb->callback([&action, &common, arguments, judge] {
        action = [&common, arguments, judge] {
            if (common.quiet) hide_progress();
            return *judge ? judge_again(*arguments) : reproduce(*arguments);
        };
    });
}

// pbskin check [-o DIR] [--junit FILE] [--baseline FILE]: checks volume preservation and other bounds in continuous integration.

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

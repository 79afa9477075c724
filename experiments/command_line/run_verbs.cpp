// pbskin run SCENE.toml [-o DIR] [--set key=value]...: runs one scene and writes frames and records.

#include "analysis/records/record_files.hpp"
#include "experiments/command_line/verbs.hpp"
#include "experiments/process/terminal.hpp"
#include "experiments/reproduce/reproduce.hpp"
#include "experiments/reproduce/studies.hpp"
#include "experiments/run/run.hpp"
#include "experiments/studies/study.hpp"
#include "experiments/studies/timing/bench.hpp"
#include "experiments/verdicts/check/check_run.hpp"
#include "pbs/geometry/input_error.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

namespace experiments {
namespace {

struct RunArguments {
    std::string scene, folder;
    std::vector<std::string> overrides;
};

int run(const RunArguments& arguments, const CommonOptions& common)
{
    Scene scene = read_scene(arguments.scene, arguments.overrides);
    const std::string folder = arguments.folder.empty() ? "results/" + scene.name : arguments.folder;
    for (DeformerSpec& spec : scene.deformers) spec.threads = common.threads;
    const RunResult result = run_scene(scene, folder);
    for (const auto& line : result.lines) spdlog::info("{}", line);
    spdlog::info("{}: {} frames, {:.1f} s, records in {}", scene.name, result.frames, result.seconds, folder);
    if (!result.breakdown.empty()) spdlog::error("pbskin: numerical breakdown: {}", result.breakdown);
    if (!result.bad_frame.empty()) spdlog::error("pbskin: {}", result.bad_frame);
    if (!result.failure().empty()) return exit_breakdown;
    say_next("pbskin report " + folder);
    return exit_finished;
}

int check(CheckArguments arguments, const CheckReports& reports, const CommonOptions& common)
{
    arguments.threads = common.threads;
    std::error_code reported_by_the_run;
    // the report may go there
    if (!reports.junit.empty()) std::filesystem::create_directories(arguments.folder, reported_by_the_run);
    require_writable(reports);
    if (!arguments.write_baseline.empty()) analysis::require_writable(arguments.write_baseline);
    analysis::require_separate({{"--write-baseline", arguments.write_baseline}, {"--junit", reports.junit}},
                               {arguments.bounds});
    analysis::require_separate({{"--junit", reports.junit}}, {arguments.baseline});
    const CheckResult result = run_check(arguments);
    if (!common.quiet) fmt::print("{}", analysis::check_table(result.suites));
    report_failures(result.suites);
    write_reports(reports, result.suites);
    const int held = count(result.suites, analysis::CheckState::held),
              failed = count(result.suites, analysis::CheckState::failed);
    spdlog::info("{} hold, {} fail, {} left out; records in {}", held, failed,
                 count(result.suites, analysis::CheckState::left_out), arguments.folder);
    if (!result.breakdowns.empty()) return exit_breakdown;
    say_next(failed > 0 ? fmt::format("pbskin report {}/SCENE", arguments.folder)
                        : "pbskin check --write-baseline FILE keeps these values, --baseline FILE compares with them");
    return failed > 0 ? exit_bound : exit_finished;
}

struct BenchArguments {
    BenchOptions options;
    std::vector<std::string> sizes;
    std::string folder;
    bool json = false;
};

// The path of the record, checked before anything is measured. "": no record is asked for.
std::string writable_record(const std::string& folder)
{
    if (folder.empty()) return "";
    analysis::make_output_folder(folder);
    const std::string record = (std::filesystem::path(folder) / "bench.json").string();
    analysis::require_writable(record);
    return record;
}

int bench(BenchArguments arguments, int threads)
{
    arguments.options.threads = threads;
    for (const std::string& size : arguments.sizes) arguments.options.sizes.push_back(parse_size(size));
    // so that the peak of memory belongs to the latest
    std::sort(arguments.options.sizes.begin(), arguments.options.sizes.end());
    const std::string file = writable_record(arguments.folder);
    const nlohmann::json record = run_bench(arguments.options);
    const std::string json = record.dump(2) + "\n";
    if (!file.empty()) analysis::write_text_atomically(file, json);
    fmt::print("{}", arguments.json ? json : bench_table(record));
    say_next(arguments.options.mesh.empty() ? "pbskin bench --mesh TETS times a mesh of yours"
                                            : "pbskin explain timing");
    return exit_finished;
}

}  // namespace

void add_run_verb(CommandLine& line)
{
    auto arguments = std::make_shared<RunArguments>();
    CLI::App* verb =
        line.add("run", "runs one scene and writes frames and records", "pbskin run limb_twist --set pbs.iterations=96",
                 [&common = line.common, arguments] { return run(*arguments, common); });
    verb->add_option("scene", arguments->scene, "a scene file, or the name of a built-in scene")->required();
    verb->add_option("-o,--output", arguments->folder, "folder of the records; by default results/NAME");
    verb->add_option("--set", arguments->overrides, "key=value, e.g. pbs.iterations=96")->allow_extra_args(false);
}

// pbskin reproduce [CLAIM or STUDY]... [-o DIR] [--quick, --full] [-j N] [--resume]
//                  [--external FILE] [--only RUN]...: runs studies and computes verdicts.

void add_reproduce_verb(CommandLine& line)
{
    auto arguments = std::make_shared<ReproduceArguments>();
    auto quick = std::make_shared<bool>(false), judge = std::make_shared<bool>(false);
    CLI::App* verb =
        line.add("reproduce", "runs studies, writes their records and computes verdicts", "pbskin reproduce C02 --full",
                 [arguments, judge] { return *judge ? judge_again(*arguments) : reproduce(*arguments); });
    verb->add_option("names", arguments->names,
                     "claims (C02) or studies (volume); by default the studies of the quick set");
    verb->add_option("-o,--output", arguments->folder, "folder of the records")->capture_default_str();
    std::vector<std::string> in_part;
    for (const Study& study : studies())
        if (study.sets.full == Extent::quick) in_part.push_back(study.name);
    auto* full =
        verb->add_flag("--full", arguments->full,
                       fmt::format("the whole studies; without names, only a part of {}", fmt::join(in_part, ", ")));
    verb->add_flag("--quick", *quick, "a part of most studies, in minutes (default)")->excludes(full);
    verb->add_option("-j,--jobs", arguments->jobs, "number of runs in parallel")
        ->check(CLI::Range(1, 256))
        ->capture_default_str();
    auto* resume = verb->add_flag("--resume", arguments->resume, "keep the runs that are finished already");
    verb->add_flag("--plan", arguments->plan_only,
                   "run nothing and print the runs to do as JSON, with their expected processor time");
    auto* external =
        verb->add_option("--external", arguments->external,
                         "a TOML file with [[external]] tables: deformers of your own for the study work_precision")
            ->type_name("FILE");
    auto* only =
        verb->add_option(
                "--only", arguments->only,
                "carries out this run alone, e.g. human_crouch, and keeps the others that are finished; may be given "
                "several times; by default all runs of the studies")
            ->type_name("RUN")
            ->expected(1)
            ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    verb->add_flag(
            "--records-only", arguments->records_only,
            "with --only: write only the records of the runs, so that several processes may work in the folder at "
            "once; the tables and verdicts follow with --resume")
        ->needs(only);
    verb->add_flag("--judge", *judge, "run nothing and compute the verdicts from the records in the folder")
        ->excludes(full)
        ->excludes(resume)
        ->excludes(external)
        ->excludes(only);
}

// pbskin check [-o DIR] [--junit FILE] [--baseline FILE]: checks volume preservation and other bounds in continuous
// integration.

void add_check_verb(CommandLine& line)
{
    auto arguments = std::make_shared<CheckArguments>();
    auto reports = std::make_shared<CheckReports>();
    CLI::App* verb = line.add(
        "check", "runs small scenes and holds them to bounds; exit 1 if one fails", "pbskin check --junit volume.xml",
        [&common = line.common, arguments, reports] { return check(*arguments, *reports, common); });
    verb->add_option("-o,--output", arguments->folder, "folder of the records")->capture_default_str();
    verb->add_option("--bounds", arguments->bounds,
                     "your scenes and bounds: TOML with [[check.scene]], [[check.bound]], [[check.tolerance]]; by "
                     "default those of the project");
    auto* baseline =
        verb->add_option("--baseline", arguments->baseline,
                         "earlier values (CSV) to compare with: counts and accuracy decide, wall time is only shown");
    verb->add_option("--write-baseline", arguments->write_baseline,
                     "write the values of this run there and compare with nothing")
        ->excludes(baseline);
    verb->add_flag("--require-all", arguments->require_all,
                   "exit 2 if the body of a scene is not installed, instead of leaving the scene out");
    verb->add_option("--junit", reports->junit, "write a JUnit report with one test case per bound");
    verb->add_flag("--github", reports->github,
                   "annotations for GitHub on stdout (the default where GITHUB_ACTIONS is true)");
}

// pbskin bench [--mesh TETS] [--threads N] [--json]: times a step and every deformer, and compares them with plain
// loops in the same run.

void add_bench_verb(CommandLine& line)
{
    auto arguments = std::make_shared<BenchArguments>();
    CLI::App* verb = line.add("bench", "times steps, deformers and FEM relative to plain loops in the same run",
                              "pbskin bench --sizes 1K,10K,100K", [&line, arguments] {
                                  const bool asked = line.app.get_subcommand("bench")->count("--threads") > 0;
                                  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
                                  return bench(*arguments, asked ? line.common.threads : cores);
                              });
    auto* mesh = verb->add_option("--mesh", arguments->options.mesh,
                                  "a tet mesh; by default bars of about 2,200 and 19,500 vertices");
    verb->add_option("--sizes", arguments->sizes,
                     "bars with these numbers of tets, e.g. 1K,10K,100K,1M, and the growth of the cost")
        ->delimiter(',')
        ->excludes(mesh);
    verb->add_flag("--json", arguments->json, "the record, for programs");
    verb->add_option("-o,--output", arguments->folder, "folder that bench.json is written to");
    verb->add_option("--seconds", arguments->options.seconds, "approximate time of the rounds on each mesh")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    verb->add_flag("--quick", arguments->options.quick,
                   "a few milliseconds, to test that it runs; the times are useless");
}

}  // namespace experiments

// pbskin bench [--mesh TETS] [--threads N] [--json]: times a step and every deformer, and compares them with plain loops in the same run.
#include "analysis/records/record_files.hpp"
#include "experiments/command_line/verbs.hpp"
#include "experiments/studies/timing/bench.hpp"
#include "pbs/geometry/input_error.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <thread>

namespace experiments {
namespace {

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
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw pbs::InputError(folder, 0, "", "", "the output folder cannot be made: " + error.message());
    const std::string record = (std::filesystem::path(folder) / "bench.json").string();
    analysis::require_writable(record);
    return record;
}

int bench(BenchArguments arguments)
{
    for (const std::string& size : arguments.sizes) arguments.options.sizes.push_back(parse_size(size));
    std::sort(arguments.options.sizes.begin(), arguments.options.sizes.end());  // so that the peak of memory belongs to the latest
    const std::string file = writable_record(arguments.folder);
    const nlohmann::json record = run_bench(arguments.options);
    const std::string json = record.dump(2) + "\n";
    if (!file.empty()) analysis::write_text_atomically(file, json);
    fmt::print("{}", arguments.json ? json : bench_table(record));
    return exit_finished;
}

}  // namespace

void add_bench_verb(CLI::App& app, CommonOptions& common, VerbAction& action)
{
    CLI::App* verb =
        add_verb(app, common, "bench", "times projections, steps, all deformers and FEM, as ratios to plain loops in the same run");
    auto arguments = std::make_shared<BenchArguments>();
    auto* mesh = verb->add_option("--mesh", arguments->options.mesh, "a tet mesh; by default bars of about 2,200 and 19,500 vertices");
    verb->add_option("--sizes", arguments->sizes, "bars with these numbers of tets, e.g. 1K,10K,100K,1M, and the growth of the cost")
        ->delimiter(',')
        ->excludes(mesh);
    verb->add_flag("--json", arguments->json, "the record, for programs");
    verb->add_option("-o,--output", arguments->folder, "folder that bench.json is written to");
    verb->add_option("--seconds", arguments->options.seconds, "approximate time of the rounds on each mesh")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    verb->add_flag("--quick", arguments->options.quick, "a few milliseconds, to test that it runs; the times are useless");
    verb->callback([&action, &common, verb, arguments] {
        const bool asked = verb->count("--threads") > 0;
        arguments->options.threads = asked ? common.threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
        action = [arguments] { return bench(*arguments); };
    });
}

}  // namespace experiments

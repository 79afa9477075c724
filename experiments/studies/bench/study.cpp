// How long a step takes: every order, precision and number of threads beside plain loops and the machine's limits, over meshes of growing
// size (bench/bench.hpp). One run, so that nothing of the study runs beside it. Writes DIR/bench/bench.json and bench.txt.
#include "analysis/records/atomic_file.hpp"
#include "experiments/studies/bench/bench.hpp"
#include "experiments/studies/study.hpp"

#include <algorithm>
#include <filesystem>
#include <thread>

namespace experiments {
namespace {

namespace fs = std::filesystem;

constexpr const char* files[] = {"bench.json", "bench.txt"};

std::string time_and_record(const BenchOptions& options, const std::string& folder)
{
    const BenchRecord record = run_bench(options);
    analysis::write_text_atomically((fs::path(folder) / "bench.json").string(), bench_json(record).dump(2) + "\n");
    analysis::write_text_atomically((fs::path(folder) / "bench.txt").string(), bench_table(record));
    return "";
}

StudyPlan plan(bool full)
{
    BenchOptions options;
    options.bars = true;
    options.sizes = {1'000, 30'000};  // the bars have 9,400 and 101,000 tets
    if (full) options.sizes.insert(options.sizes.end(), {300'000, 1'000'000});
    options.threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    StudyPlan plan;
    plan.runs.push_back({.name = "timings",
                         .cost_s = full ? 240.0 : 90.0,
                         .work = [options](const std::string& folder) { return time_and_record(options, folder); },
                         .settings = {{"sizes", options.sizes}, {"threads", options.threads}}});
    return plan;
}

StudyConclusion conclude(const FinishedRuns& finished)
{
    if (finished.none()) return {"bench: nothing was timed\n", false};
    for (const std::string name : files)
        for (const std::string& file : finished.files(name)) finished.write(name, analysis::read_text(file));
    return {analysis::read_text((fs::path(finished.folder) / "bench.txt").string()), true};
}

}  // namespace

Study bench_study()
{
    return {"bench", plan, full_in_short, conclude, true};
}

}  // namespace experiments

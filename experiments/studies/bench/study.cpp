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

}  // namespace

StudyPlan plan_bench_study(bool full)
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

StudyConclusion conclude_bench_study(const std::string& folder, const StudyPlan&, const std::vector<std::string>& finished)
{
    if (finished.empty()) return {"bench: nothing was timed\n", false};
    for (const char* file : files) {
        const std::string text = analysis::read_text((fs::path(finished.front()) / file).string());
        analysis::write_text_atomically((fs::path(folder) / file).string(), text);
    }
    return {analysis::read_text((fs::path(folder) / "bench.txt").string()), true};
}

}  // namespace experiments

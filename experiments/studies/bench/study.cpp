// How long a step takes: every order, precision and number of threads, relative to plain loops, over meshes of growing size
// (bench/bench.hpp). The study has one run, so that nothing else runs meanwhile. Writes DIR/bench/bench.json and bench.txt.
#include "analysis/records/record_files.hpp"
#include "experiments/studies/bench/bench.hpp"
#include "experiments/studies/study.hpp"

#include <algorithm>
#include <thread>

namespace experiments {
namespace {

std::string time_and_record(const BenchOptions& options, const std::string& folder)
{
    const BenchRecord record = run_bench(options);
    analysis::write_text_atomically(analysis::path_in(folder, "bench.json"), bench_json(record).dump(2) + "\n");
    analysis::write_text_atomically(analysis::path_in(folder, "bench.txt"), bench_table(record));
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
    plan.runs.push_back(work_run("timings", options, full ? 240.0 : 90.0, time_and_record));
    return plan;
}

StudyConclusion conclude(const FinishedRuns& finished)
{
    if (finished.none()) return {"bench: nothing was timed\n", false};
    for (const char* name : {"bench.json", "bench.txt"})
        for (const std::string& file : finished.files(name)) finished.write(name, analysis::read_text(file));
    return {analysis::read_text(analysis::path_in(finished.folder, "bench.txt")), true};
}

}  // namespace

Study bench_study()
{
    return {"bench", plan, full_in_short, conclude, true};
}

}  // namespace experiments

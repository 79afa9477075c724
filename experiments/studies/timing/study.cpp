// The time of the method and of its parts. Of each case one run is timed at once.
//
//   BODY_VERTICES    C10: milliseconds per frame on one core for LBS, bind, stretch, volume and the whole frame
//                    (timing.hpp). man, frankie and lady at the sizes of Table 1, the human at the same sizes and on a
//                    ladder of sizes.
//   bench            a step in each order, precision and number of threads, and all deformers, relative to plain loops
//                    (bench.hpp)
//   features_SCENE   what each switch of a scene costs, and how far it moves the result; features_sizes: what a larger
//                    mesh costs
//   equal_quality_CASE  the time to an equal answer of every order, precision and sequence of the constraints
//                       (timing.hpp)
//
// Writes DIR/timing/RUN/timing.csv and measurements.csv, bench.json and bench.txt, features.csv, or orders.csv and
// targets.csv; and in DIR/timing timing.csv, real_time.csv, features.csv, answers.csv and bench.txt over all runs.
#include "analysis/records/record_files.hpp"
#include "experiments/characters/bodies.hpp"
#include "experiments/studies/shared/bodies.hpp"
#include "experiments/studies/study.hpp"
#include "experiments/studies/timing/bench.hpp"
#include "experiments/studies/timing/timing.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>
#include <thread>

namespace experiments {
namespace {

// A mesh is made to a row of Table 1 or to a number of vertices.
StudyRun run_of_frames(const StudyCase& study_case)
{
    TimedCase timed{.name = study_case.name, .scene = {}, .model = study_case.value<std::string>("model", "")};
    const TableOneRow* row = table_1_row(timed.model);
    if (row) timed.k_jiggle = row->jiggling;
    const auto body = study_case.value<std::string>("body");
    pbs::require_body(body);
    const int vertices = row ? row->vertices : study_case.value<int>("vertices");
    timed.scene = read_scene("human_01_01", {"character.body=" + body, fmt::format("character.vertices={}", vertices),
                                             "motion.duration_s=4.0"});
    timed.scene.character.refinements = study_case.value("refinements", 0);
    timed.stands_in = study_case.value("stands_in", false);
    timed.seconds = study_case.value("seconds", 4.0);
    timed.fewest_rounds = study_case.value("fewest_rounds", 3);
    return work_run(study_case.name, timed, study_case.cost_s, measure_frames);
}

// On all processors of the machine that measures, which need not be the one that planned the run.
std::string measure_bench(const BenchOptions& planned, const std::string& folder)
{
    BenchOptions options = planned;
    options.threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    const nlohmann::json record = run_bench(options);
    analysis::write_text_atomically(analysis::path_in(folder, "bench.json"), record.dump(2) + "\n");
    analysis::write_text_atomically(analysis::path_in(folder, "bench.txt"), bench_table(record));
    return "";
}

StudyRun run_of_bench(const StudyCase& study_case)
{
    const BenchOptions bench{// the bars have 9,400 and 101,000 tets
                             .mesh = "",
                             .bars = true,
                             .sizes = study_case.value<std::vector<int>>("sizes"),
                             .threads = 0};  // see measure_bench
    return work_run(study_case.name, bench, study_case.cost_s, measure_bench);
}

StudyRun run_of_features(const StudyCase& study_case)
{
    const FeaturesCase features{.name = study_case.value<std::string>("of"),
                                .scene = study_case.value<std::string>("scene"),
                                .cut = study_case.value<std::vector<std::string>>("overrides"),
                                .features = features_of(study_case),
                                .rounds = {.seconds = study_case.cost_s - 10.0, .fewest = 3, .most = 7}};
    read_scene(features.scene, features.cut);  // a body that is not installed is refused before anything runs
    return work_run(study_case.name, features, study_case.cost_s, measure_features);
}

StudyRun run_of_equal_quality(const StudyCase& study_case)
{
    const EqualQualityCase orders{.of = study_case.key(),
                                  .scene = study_case.scene(),
                                  .frame = study_case.value<int>("frame"),
                                  .random = {1, 2, 3, 4, 5},
                                  .most_iterations = 16000,
                                  .rounds = {.seconds = 20.0, .fewest = 5, .most = 61}};
    return work_run(study_case.name, orders, study_case.cost_s, measure_equal_quality);
}

StudyPlan plan(bool full)
{
    static const std::map<std::string, StudyRun (*)(const StudyCase&)> runs = {{"frames", run_of_frames},
                                                                               {"bench", run_of_bench},
                                                                               {"features", run_of_features},
                                                                               {"equal_quality", run_of_equal_quality}};
    return plan_of_cases("timing", full, [](const StudyCase& study_case, StudyPlan& plan) {
        plan.runs.push_back(runs.at(study_case.value<std::string>("times"))(study_case));
    });
}

bool conclude(const FinishedRuns& finished)
{
    const auto write = [&](const std::string& file, const analysis::CsvTable& table) {
        if (table.rows() > 0) finished.write(file, table);
    };
    const analysis::CsvTable timings = finished.table(timing_columns.names(), "timing.csv");
    write("timing.csv", timings);
    if (timings.rows() > 0) finished.write("real_time.csv", real_time_ends(timings));
    for (const std::string& file : finished.files("bench.txt")) finished.write("bench.txt", analysis::read_text(file));
    write("features.csv", finished.table(feature_columns.names(), "features.csv"));
    write("answers.csv", equal_answers(finished.table(target_columns.names(), "targets.csv")));
    return true;
}

}  // namespace

Study timing_study()
{
    return {"timing", plan, quick_and_full, conclude, true, nullptr, nullptr, timing_conclusions};
}

}  // namespace experiments

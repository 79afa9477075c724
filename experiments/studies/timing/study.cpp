// The time of the method and of its parts. Of each case one run is timed at once.
//
//   BODY_VERTICES    C10: milliseconds per frame on one core for LBS, bind, stretch, volume and the whole frame (frames.hpp). man, frankie
//                    and lady at the sizes of Table 1, the human at the same sizes and on a ladder of sizes.
//   bench            a step in each order, precision and number of threads, and all deformers, relative to plain loops (bench.hpp)
//   features_SCENE   what each switch of a scene costs, and how far it moves the result; features_sizes: what a larger mesh costs
//   equal_quality_CASE  the time to an equal answer of every order, precision and sequence of the constraints (equal_quality.hpp)
//
// Writes DIR/timing/RUN/timing.csv and measurements.csv, bench.json and bench.txt, features.csv, or orders.csv and targets.csv; and in
// DIR/timing timing.csv, features.csv and answers.csv over all runs, timing.md, features.md, equal_quality.md and bench.txt.
#include "analysis/records/record_files.hpp"
#include "analysis/records/report_table.hpp"
#include "experiments/studies/shared/bodies.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "experiments/studies/study.hpp"
#include "experiments/studies/timing/bench.hpp"
#include "experiments/studies/timing/equal_quality.hpp"
#include "experiments/studies/timing/features.hpp"
#include "experiments/studies/timing/frames.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <functional>
#include <thread>

namespace experiments {
namespace {

constexpr double set_up_s = 1.0;  // half of the time for meshing: tets are kept from one run of the program to the next

constexpr const char* feature_table =
    "scene feature frame_cpu_ms_without:.2f frame_cpu_ms_with:.2f frame_cpu_ms_ratio:.2f frame_cpu_ms_ratio_lower:.2f "
    "frame_cpu_ms_ratio_upper:.2f frame_ms_without:.2f frame_ms_with:.2f step_cpu_ms_without:.2f step_cpu_ms_with:.2f "
    "start_s_without:.2f start_s_with:.2f peak_mb_without:.0f peak_mb_with:.0f shared_objects_without shared_objects_with "
    "largest_distance_m:.2g volume_difference_pct:.2g";

// A run whose body is not installed is left out.
void add(StudyPlan& plan, const std::string& name, const std::function<StudyRun(const std::string& name)>& run)
{
    try {
        plan.runs.push_back(run(name));
    } catch (const pbs::InputError& error) {
        plan.left_out.push_back({name, error.what()});
    }
}

std::string body_of(const std::string& model)
{
    return model.starts_with("Man") ? "man" : model.starts_with("bunny") ? "frankie" : "lady";
}

void add_frames(StudyPlan& plan, bool full)
{
    const std::vector<std::string> installed = installed_bodies(plan.left_out);
    const double seconds = full ? 4.0 : 1.5;
    const auto add_mesh = [&](TimedCase of, const std::string& body, int vertices, int refinements, double before_s) {
        if (std::find(installed.begin(), installed.end(), body) == installed.end()) return;
        add(plan, fmt::format("{}_{}", body, vertices), [&](const std::string&) {
            of.seconds = seconds;
            of.scene = read_scene("human_01_01", {fmt::format(R"(character.body="{}")", body),
                                                  fmt::format("character.vertices={}", vertices), "motion.duration_s=4.0"});
            of.scene.character.refinements = refinements;
            return work_run(of.name(), of, seconds + before_s, measure_frames);
        });
    };
    for (const TableOneRow& row : table_1()) {
        TimedCase of{.scene = {}, .model = row.model, .k_jiggle = row.jiggling};
        add_mesh(of, body_of(row.model), row.vertices, 0, set_up_s);
        of.stands_in = true;
        if (full || row.model == "Man" || row.model == "bunnyHQ") add_mesh(of, "human", row.vertices, 0, set_up_s);
    }
    for (const int vertices : full ? std::vector<int>{1200, 2400, 4800, 9600, 20000} : std::vector<int>{1200, 4800, 20000})
        add_mesh({}, "human", vertices, 0, set_up_s + vertices / 4000.0);
    if (full) add_mesh({}, "human", 2400, 2, 16.0);
}

std::string measure_bench(const BenchOptions& options, const std::string& folder)
{
    const nlohmann::json record = run_bench(options);
    analysis::write_text_atomically(analysis::path_in(folder, "bench.json"), record.dump(2) + "\n");
    analysis::write_text_atomically(analysis::path_in(folder, "bench.txt"), bench_table(record));
    return "";
}

void add_features(StudyPlan& plan)
{
    const std::vector<std::pair<FeaturesCase, double>> cases = {
        {{"limb", "limb_bend", {"motion.frames=11"}}, 35.0},
        {{"human", "human_01_01", {"motion.start_s=1.5", "motion.duration_s=0.2"}, true}, 55.0},
        {{"sizes",
          "human_01_01",
          {"motion.start_s=1.6", "motion.duration_s=0.05", "output.frames_every=1"},
          false,
          {600, 2400, 7000, 20000}},
         60.0}};
    for (auto [of, cost_s] : cases)
        add(plan, "features_" + of.name, [&](const std::string& name) {
            read_scene(of.scene, of.cut);  // a body that is not installed is refused before anything runs
            of.rounds = {.seconds = cost_s, .fewest = 3, .most = 7};
            return work_run(name, of, cost_s + 10.0, measure_features);
        });
}

void add_equal_quality(StudyPlan& plan)
{
    const auto add_case = [&](const std::string& name, const analysis::CaseKey& key, bool is_tapered) {
        add(plan, "equal_quality_" + name, [&](const std::string& run) {
            EqualQualityCase of{.of = key, .scene = {}, .is_tapered = is_tapered, .random = {1, 2, 3, 4, 5}, .most_iterations = 16000};
            const bool is_twist = key.motion == "twist";
            of.scene = is_twist ? read_scene("limb_twist", {fmt::format("motion.angle_deg={}", *key.angle_deg), "motion.frames=2"})
                                : read_scene("human_01_01", {});
            of.frame = is_twist ? 1 : clip_frames::crouch;
            of.rounds = {.seconds = 20.0, .fewest = 5, .most = 61};
            return work_run(run, of, 150.0, measure_equal_quality);
        });
    };
    add_case("limb_twist_150", {.body = "limb", .motion = "twist", .angle_deg = 150.0}, false);
    add_case("tapered_limb_twist_165", {.body = "tapered_limb", .motion = "twist", .angle_deg = 165.0}, true);
    add_case("human_crouch", {.body = "human", .motion = "01_01", .pose = "crouch"}, false);
}

// The quick form has the frames at the sizes of Table 1, by which a claim is judged.
StudyPlan plan(bool full)
{
    StudyPlan plan;
    add_frames(plan, full);
    if (!full) return plan;
    BenchOptions bench{.mesh = "", .bars = true, .sizes = {1'000, 30'000, 300'000, 1'000'000}};  // the bars have 9,400 and 101,000 tets
    bench.threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    plan.runs.push_back(work_run("bench", bench, 240.0, measure_bench));
    add_features(plan);
    add_equal_quality(plan);
    return plan;
}

StudyConclusion conclude(const FinishedRuns& finished)
{
    if (finished.none()) return {"timing: nothing was timed\n", false};
    std::string text;
    if (const std::vector<TimingRow> frames = finished.rows(timing_columns, "timing.csv"); !frames.empty()) {
        finished.write("timing.csv", timing_columns, frames);
        finished.write("timing.md", timing_markdown(frames));
        text += timing_text(frames);
    }
    for (const std::string& file : finished.files("bench.txt")) {
        finished.write("bench.txt", analysis::read_text(file));
        text += analysis::read_text(file);
    }
    if (const std::vector<FeatureRow> features = finished.rows(feature_columns, "features.csv"); !features.empty()) {
        const analysis::CsvTable table = table_of(feature_columns, features);
        finished.write("features.csv", table);
        const std::string page = markdown_table(table, analysis::report_columns(feature_table));
        finished.write("features.md", page);
        text += page;
    }
    if (const std::vector<TargetRow> targets = finished.rows(target_columns, "targets.csv"); !targets.empty()) {
        const std::vector<EqualAnswer> answers = equal_answers(targets);
        finished.write("answers.csv", answer_columns, answers);
        const std::string page = order_report(finished.rows(order_columns, "orders.csv"), answers);
        finished.write("equal_quality.md", page);
        text += page;
    }
    return {text, true};
}

}  // namespace

Study timing_study()
{
    return {"timing", plan, quick_and_full, conclude, true};
}

}  // namespace experiments

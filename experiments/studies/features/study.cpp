// The cost of a feature of a scene: time per frame, time to start and peak memory, with it and without it, and how far the result moves.
// The scenes take turns in one run, each in a process of its own.
//
//   limb   the capsule limb, bent to 150 degrees in 11 frames
//   human  MakeHuman's body, 21 frames of the clip's jump
//
// Writes DIR/features/SCENE/features.csv, DIR/features/features.csv and features.md.
#include "analysis/records/record_files.hpp"
#include "analysis/records/report_table.hpp"
#include "experiments/process/child_process.hpp"
#include "experiments/process/terminal.hpp"
#include "experiments/studies/features/feature_cost.hpp"
#include "experiments/studies/shared/timed_rounds.hpp"
#include "experiments/studies/study.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>

namespace experiments {
namespace {

constexpr const char* shown_columns =
    "scene feature frame_cpu_ms_without:.2f frame_cpu_ms_with:.2f frame_cpu_ms_ratio:.2f frame_cpu_ms_ratio_lower:.2f "
    "frame_cpu_ms_ratio_upper:.2f frame_ms_without:.2f frame_ms_with:.2f step_cpu_ms_without:.2f step_cpu_ms_with:.2f "
    "start_s_without:.2f start_s_with:.2f peak_mb_without:.0f peak_mb_with:.0f shared_objects_without shared_objects_with "
    "largest_distance_m:.2g volume_difference_pct:.2g";

// Gives stderr a terminal of its own, so that the bar is drawn and nobody sees it.
void draw_progress_unseen()
{
    const int master = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
    if (master < 0 || grantpt(master) != 0 || unlockpt(master) != 0) throw std::runtime_error("no terminal to draw a bar on");
    const int slave = open(ptsname(master), O_RDWR | O_NOCTTY | O_NONBLOCK);
    if (slave < 0 || dup2(slave, STDERR_FILENO) < 0) throw std::runtime_error("no terminal to draw a bar on");
    show_progress();
}

std::optional<ResultChange> change_by(const Feature& feature, const FeaturesCase& of)
{
    if (!feature.changes_result) return std::nullopt;
    const Scene without = scene_of(of.scene, of.cut, feature.without), with = scene_of(of.scene, of.cut, feature.with);
    const nlohmann::json change = in_own_process([&] {
        const ResultChange found = change_between(without, with);
        return nlohmann::json{found.distance_m, found.volume_difference_pct};
    });
    return ResultChange{change.at(0), change.at(1)};
}

// Returns the first breakdown. A bad frame is no failure here, since no reference has to reach a bend of 150 degrees.
std::string measure_and_record(const FeaturesCase& of, const std::string& folder)
{
    std::vector<Feature> asked;
    std::vector<Variant> variants;  // each once, however many features it is a part of
    for (const Feature& feature : features()) {
        if (feature.needs_surface && !of.has_surface) continue;
        asked.push_back(feature);
        for (const Variant& variant : {feature.without, feature.with})
            if (std::find(variants.begin(), variants.end(), variant) == variants.end()) variants.push_back(variant);
    }
    const std::string scratch = analysis::path_in(folder, "scratch");
    std::string breakdown;
    std::vector<TimedVariant> turns;
    for (const Variant& variant : variants)
        turns.push_back([&] {
            const Scene scene = scene_of(of.scene, of.cut, variant);
            const nlohmann::json run = run_scene_alone(scene, scratch, variant.progress ? draw_progress_unseen : nullptr);
            if (breakdown.empty()) breakdown = run.at("outcome").at("breakdown");
            return costs_of_run(run, scene);
        });
    const std::vector<Samples> costs = take_turns(turns, of.rounds);
    std::filesystem::remove_all(scratch);

    const auto costs_with = [&](const Variant& variant) {
        return costs[std::find(variants.begin(), variants.end(), variant) - variants.begin()];
    };
    std::vector<FeatureRow> rows;
    for (const Feature& feature : asked)
        rows.push_back(feature_row(of.name, feature.name, costs_with(feature.without), costs_with(feature.with), change_by(feature, of)));
    table_of(feature_columns, rows).write(analysis::path_in(folder, "features.csv"));
    return breakdown;
}

StudyRun features_run(FeaturesCase of, double cost_s, bool full)
{
    of.rounds = {.seconds = cost_s, .fewest = 3, .most = full ? 25 : 7};
    read_scene(of.scene, of.cut);  // a body that is not installed is refused before anything runs
    return work_run(of.name, of, cost_s + 10.0, measure_and_record);
}

StudyPlan plan(bool full)
{
    StudyPlan plan;
    plan.runs.push_back(features_run({"limb", "limb_bend", {"motion.frames=11"}}, full ? 200.0 : 35.0, full));
    try {
        plan.runs.push_back(
            features_run({"human", "human_01_01", {"motion.start_s=1.5", "motion.duration_s=0.2"}, true}, full ? 300.0 : 55.0, full));
    } catch (const pbs::InputError& error) {
        plan.left_out.push_back({"human", error.what()});
    }
    return plan;
}

StudyConclusion conclude(const FinishedRuns& finished)
{
    if (finished.none()) return {"", false};
    const analysis::CsvTable all = table_of(feature_columns, finished.rows(feature_columns, "features.csv"));
    finished.write("features.csv", all);
    const std::string text = markdown_table(all, analysis::report_columns(shown_columns));
    finished.write("features.md", text);
    return {text, true};
}

}  // namespace

Study features_study()
{
    return {"features", plan, full_in_short, conclude, true};
}

}  // namespace experiments

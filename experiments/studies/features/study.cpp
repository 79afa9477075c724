// What a feature of a scene costs: time a frame, time to start and peak memory with and without it, by turns in one run, each scene in a
// process of its own; and how far the answer moves.
//
//   limb   the capsule limb, bent to 150 degrees in 11 frames
//   human  MakeHuman's body, 21 frames of the clip's jump
//
// Writes DIR/features/SCENE/features.csv, DIR/features/features.csv and features.md.
#include "analysis/records/atomic_file.hpp"
#include "experiments/studies/features/feature_table.hpp"
#include "experiments/process/own_process.hpp"
#include "experiments/studies/study.hpp"
#include "pbs/geometry/input_error.hpp"

#include <algorithm>
#include <filesystem>

namespace experiments {
namespace {

namespace fs = std::filesystem;

struct CutScene {
    std::string name, built_in;
    std::vector<std::string> cut;
    bool has_surface = false;
    Rounds rounds = {};
};

// Each variant once, however many features it is a part of.
std::vector<Variant> variants_of(const std::vector<Feature>& asked)
{
    std::vector<Variant> variants;
    for (const Feature& feature : asked)
        for (const Variant& variant : {feature.without, feature.with})
            if (std::find(variants.begin(), variants.end(), variant) == variants.end()) variants.push_back(variant);
    return variants;
}

std::vector<std::vector<SceneCost>> costs_by_turns(const CutScene& scene, const std::vector<Variant>& variants, const std::string& scratch)
{
    std::vector<std::vector<SceneCost>> costs(variants.size());
    std::vector<TimedVariant> turns;
    for (std::size_t i = 0; i < variants.size(); ++i)
        turns.push_back([&, i] {
            costs[i].push_back(cost_of(scene_of(scene.built_in, scene.cut, variants[i]), variants[i], scratch));
            return std::vector<double>{};
        });
    take_turns(turns, scene.rounds);
    for (auto& rounds : costs) rounds.erase(rounds.begin());  // the first warms up
    return costs;
}

// The first one's, if any: bad frames are no failure here, a bend of 150 degrees is none that a reference must reach.
std::string breakdown_among(const std::vector<std::vector<SceneCost>>& costs)
{
    for (const auto& rounds : costs)
        for (const SceneCost& cost : rounds)
            if (!cost.breakdown.empty()) return cost.breakdown;
    return "";
}

std::optional<AnswerChange> change_of(const CutScene& scene, const Feature& feature)
{
    if (!feature.changes_answer) return std::nullopt;
    const Scene without = scene_of(scene.built_in, scene.cut, feature.without), with = scene_of(scene.built_in, scene.cut, feature.with);
    const nlohmann::json told = in_own_process([&] {
        const AnswerChange change = change_between(without, with);
        return nlohmann::json{change.distance_m, change.volume_difference_pct};
    });
    return AnswerChange{told.at(0).get<double>(), told.at(1).get<double>()};
}

std::string measure_and_record(const CutScene& scene, const std::string& folder)
{
    std::vector<Feature> asked;
    for (const Feature& feature : features())
        if (scene.has_surface || !feature.needs_surface) asked.push_back(feature);
    const std::vector<Variant> variants = variants_of(asked);
    const std::string scratch = (fs::path(folder) / "scratch").string();
    const auto costs = costs_by_turns(scene, variants, scratch);
    fs::remove_all(scratch);
    const auto costs_of = [&](const Variant& variant) {
        return costs[std::find(variants.begin(), variants.end(), variant) - variants.begin()];
    };
    std::vector<FeatureRow> rows;
    for (const Feature& feature : asked)
        rows.push_back({scene.name, feature.name, costs_of(feature.without), costs_of(feature.with), change_of(scene, feature)});
    features_csv(rows).write((fs::path(folder) / "features.csv").string());
    return breakdown_among(costs);
}

StudyRun features_run(CutScene scene, double cost_s, bool full)
{
    scene.rounds = {.seconds = cost_s, .fewest = 3, .most = full ? 25 : 7};
    read_scene(scene.built_in, scene.cut);  // not installed: told before anything runs
    return {.name = scene.name,
            .cost_s = cost_s + 10.0,
            .work = [scene](const std::string& folder) { return measure_and_record(scene, folder); },
            .settings = {{"scene", scene.built_in}, {"cut", scene.cut}, {"full", full}}};
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
    const analysis::CsvTable all = finished.gathered("features.csv");
    finished.write("features.csv", all);
    const std::string text = features_markdown(all);
    finished.write("features.md", text);
    return {text, true};
}

}  // namespace

Study features_study()
{
    return {"features", plan, full_in_short, conclude, true};
}

}  // namespace experiments

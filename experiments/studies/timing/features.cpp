// What each optional feature of a scene costs, such as threads or sleep: measure_features of timing.hpp. A feature is a
// pair of scenes that differ in it alone. Every scene of the pairs runs in a process of its own, the scenes take turns,
// and features.csv has one row per feature.

#include "experiments/studies/timing/timing.hpp"

#include "analysis/metrics/frame_metrics.hpp"
#include "analysis/records/record_files.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/process/child_process.hpp"
#include "experiments/process/terminal.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/settings/recorded_settings.hpp"
#include "experiments/studies/shared/timed_rounds.hpp"
#include "pbs/solver/options.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <tuple>

#include <fcntl.h>
#include <unistd.h>

namespace experiments {

std::vector<Feature> features_of(const StudyCase& study_case)
{
    std::vector<Feature> features;
    for (const nlohmann::json& table : study_case.value<nlohmann::json>("features")) {
        if (table.contains("only") && table.at("only") != study_case.value<std::string>("body")) continue;
        Feature& feature = features.emplace_back(Feature{.name = table.at("name")});
        feature.without.overrides = table.value("without", std::vector<std::string>{});
        feature.with = {table.value("with", std::vector<std::string>{}), table.value("threads", 1),
                        table.value("progress", false)};
        feature.changes_result = table.value("changes_result", false);
    }
    return features;
}

Scene scene_of(const std::string& name, const std::vector<std::string>& cut, const Variant& variant)
{
    // The bare scene has PBS alone, no reference, no frames on disk, and no metrics except the volume.
    std::vector<std::string> overrides = {R"(deformers.use=["pbs"])", R"(reference.name="")",  "output.frames_every=0",
                                          "output.frames=[]",         "output.frame_names=[]", "output.metrics=[]"};
    overrides.insert(overrides.end(), cut.begin(), cut.end());
    overrides.insert(overrides.end(), variant.overrides.begin(), variant.overrides.end());
    Scene scene = read_scene(name, overrides);
    for (DeformerSpec& spec : scene.deformers) spec.threads = variant.threads;
    return scene;
}

namespace {

using analysis::Columns;
using analysis::within;

// The costs that are compared, with their names in features.csv, in the order of costs_of_run.
constexpr std::pair<Compared FeatureRow::*, const char*> compared_costs[] = {
    {&FeatureRow::frame_ms, "frame_ms"}, {&FeatureRow::frame_cpu_ms, "frame_cpu_ms"},
    {&FeatureRow::step_ms, "step_ms"},   {&FeatureRow::step_cpu_ms, "step_cpu_ms"},
    {&FeatureRow::start_s, "start_s"},   {&FeatureRow::peak_mb, "peak_mb"}};

Columns<FeatureRow> cost_columns()
{
    const QuartileEndings quartile_endings = {"_lower", "_upper"};
    const std::pair<Spread Compared::*, const char*> spreads[] = {
        {&Compared::without, "_without"}, {&Compared::with, "_with"}, {&Compared::ratio, "_ratio"}};
    Columns<FeatureRow> columns;
    for (const auto& [cost, name] : compared_costs)
        for (const auto& [spread, ending] : spreads)
            columns =
                columns + within(cost, within(spread, spread_columns(std::string(name) + ending, quartile_endings)));
    return columns;
}

// std::logic_error if the scene has no PBS.
const DeformerSpec& pbs_of(const Scene& scene)
{
    const DeformerSpec* pbs = find_deformer_with<pbs::PbsOptions>(scene);
    if (!pbs) throw std::logic_error("a scene without PBS");
    return *pbs;
}

// The seconds before the first frame. seconds: cost.seconds or cost.cpu_seconds of run.json.
double start_of(const nlohmann::json& seconds)
{
    double sum = seconds.value("error_bar_set_up", 0.0);  // only a reference with an error bar has it
    for (const char* part : {"character", "motion", "set_up", "metrics_set_up"}) sum += seconds.at(part).get<double>();
    return sum;
}

// Gives stderr a terminal of its own, so that the progress bar is drawn although nobody sees it.
void draw_progress_unseen()
{
    const int master = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
    if (master < 0 || grantpt(master) != 0 || unlockpt(master) != 0)
        throw std::runtime_error("no terminal to draw a bar on");
    const int slave = open(ptsname(master), O_RDWR | O_NOCTTY | O_NONBLOCK);
    if (slave < 0 || dup2(slave, STDERR_FILENO) < 0) throw std::runtime_error("no terminal to draw a bar on");
    show_progress();
}

// How far the feature moves the result, measured in a process of its own. It is empty for a feature that does not
// change the result.
std::optional<ResultChange> change_by(const Feature& feature, const FeaturesCase& features_case)
{
    if (!feature.changes_result) return std::nullopt;
    const Scene without = scene_of(features_case.scene, features_case.cut, feature.without);
    const Scene with = scene_of(features_case.scene, features_case.cut, feature.with);
    const nlohmann::json change = in_own_process([&] {
        const ResultChange measured = change_between(without, with);
        return nlohmann::json{measured.distance_m, measured.volume_difference_pct};
    });
    return ResultChange{change.at(0), change.at(1)};
}

}  // namespace

using Rows = Columns<FeatureRow>;
const Rows feature_columns =
    MEMBER_COLUMNS(FeatureRow, scene, feature, rounds) + cost_columns() +
    MEMBER_COLUMNS(FeatureRow, shared_objects_without, shared_objects_with) +
    within(&FeatureRow::change, Columns<ResultChange>{{"largest_distance_m", &ResultChange::distance_m},
                                                      {"volume_difference_pct", &ResultChange::volume_difference_pct}});

RECORD_SETTINGS(Variant, overrides, threads, progress)
RECORD_SETTINGS(Feature, name, without, with, changes_result)
RECORD_SETTINGS(FeaturesCase, name, scene, cut, features, rounds)

Compared compare(const std::vector<double>& without, const std::vector<double>& with)
{
    const Spread ratio = spread_of_ratios(with, without);
    return {spread_of(without), spread_of(with), ratio};
}

std::vector<double> costs_of_run(const nlohmann::json& run, const Scene& scene)
{
    const nlohmann::json& cost = run.at("cost");
    const double ms_per_frame = 1e3 / run.at("outcome").at("frames").get<double>();
    // milliseconds per frame of the whole run and of the steps of PBS
    const auto frame_and_step = [&](const nlohmann::json& seconds) {
        const double frames_s = seconds.at("total").get<double>() - start_of(seconds);
        const double steps_s = seconds.at("deformers").at(pbs_of(scene).label).at("step");
        return std::pair(ms_per_frame * frames_s, ms_per_frame * steps_s);
    };
    const auto [frame_ms, step_ms] = frame_and_step(cost.at("seconds"));
    const auto [frame_cpu_ms, step_cpu_ms] = frame_and_step(cost.at("cpu_seconds"));
    return {frame_ms,
            frame_cpu_ms,
            step_ms,
            step_cpu_ms,
            start_of(cost.at("seconds")),
            cost.at("peak_memory_mb"),
            cost.at("shared_objects")};
}

FeatureRow feature_row(const std::string& scene, const std::string& feature, const Samples& without,
                       const Samples& with, const std::optional<ResultChange>& change)
{
    FeatureRow row;
    row.scene = scene;
    row.feature = feature;
    row.change = change;
    std::size_t cost = 0;
    for (const auto& [compared, name] : compared_costs) {
        row.*compared = compare(without.at(cost), with.at(cost));
        ++cost;
    }
    row.rounds = row.frame_ms.ratio.rounds;
    row.shared_objects_without = static_cast<int>(without.at(cost).back());
    row.shared_objects_with = static_cast<int>(with.at(cost).back());
    return row;
}

ResultChange change_between(const Scene& without, const Scene& with)
{
    const pbs::Character character = pbs::make_character(without.character);
    const pbs::Motion motion = make_motion(without.motion, character.skeleton, without.file);
    const analysis::MeshMetrics mesh_metrics(character.mesh.rest, character.mesh.tets);
    const auto deformer_without = make_deformer(pbs_of(without));
    const auto deformer_with = make_deformer(pbs_of(with));
    deformer_without->reset(character);
    deformer_with->reset(character);
    ResultChange change;
    for (const pbs::Pose& pose : motion.steps) {
        deformer_without->advance(pose, motion.time_step_s);
        deformer_with->advance(pose, motion.time_step_s);
        const pbs::Positions& positions_without = deformer_without->positions();
        const pbs::Positions& positions_with = deformer_with->positions();
        const double distance_m = (positions_without - positions_with).rowwise().norm().maxCoeff();
        const double volume_difference_pct = mesh_metrics.measure(positions_without).volume_change_pct -
                                             mesh_metrics.measure(positions_with).volume_change_pct;
        change.distance_m = std::max(change.distance_m, distance_m);
        change.volume_difference_pct = std::max(change.volume_difference_pct, std::abs(volume_difference_pct));
    }
    return change;
}

// Returns the first breakdown. A bad frame is no failure here, since no reference has to reach a bend of 150 degrees.
std::string measure_features(const FeaturesCase& features_case, const std::string& folder)
{
    std::vector<Variant> variants;  // Each variant is measured once, even if several features have it.
    for (const Feature& feature : features_case.features)
        for (const Variant& variant : {feature.without, feature.with})
            if (std::ranges::find(variants, variant) == variants.end()) variants.push_back(variant);
    const std::string scratch = analysis::path_in(folder, "scratch");
    std::string breakdown;
    std::vector<TimedVariant> turns;
    for (const Variant& variant : variants)
        turns.push_back([&] {
            const Scene scene = scene_of(features_case.scene, features_case.cut, variant);
            const nlohmann::json run =
                run_scene_alone(scene, scratch, variant.progress ? draw_progress_unseen : nullptr);
            if (breakdown.empty()) breakdown = run.at("outcome").at("breakdown");
            return costs_of_run(run, scene);
        });
    const std::vector<Samples> costs = take_turns(turns, features_case.rounds);
    std::filesystem::remove_all(scratch);

    const auto costs_with = [&](const Variant& variant) {
        return costs[std::ranges::find(variants, variant) - variants.begin()];
    };
    std::vector<FeatureRow> rows;
    for (const Feature& feature : features_case.features)
        rows.push_back(feature_row(features_case.name, feature.name, costs_with(feature.without),
                                   costs_with(feature.with), change_by(feature, features_case)));
    table_of(feature_columns, rows).write(analysis::path_in(folder, "features.csv"));
    return breakdown;
}

}  // namespace experiments

#include "experiments/studies/features/feature_cost.hpp"

#include "analysis/metrics/frame_metrics.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/settings/option_fields.hpp"
#include "pbs/solver/options.hpp"

#include <algorithm>
#include <stdexcept>

namespace experiments {
namespace {

using analysis::Columns;
using analysis::within;

constexpr Compared FeatureRow::*compared_costs[] = {&FeatureRow::frame_ms,    &FeatureRow::frame_cpu_ms, &FeatureRow::step_ms,
                                                    &FeatureRow::step_cpu_ms, &FeatureRow::start_s,      &FeatureRow::peak_mb};

Columns<FeatureRow> pair_columns(Compared FeatureRow::*part, const std::string& name, const std::string& unit, const std::string& meaning)
{
    const QuartileEndings endings = {"_lower", "_upper"};
    const Columns<Compared> columns = within(&Compared::without, spread_columns(name + "_without", unit, meaning + ", without", endings)) +
                                      within(&Compared::with, spread_columns(name + "_with", unit, meaning + ", with", endings)) +
                                      within(&Compared::ratio, spread_columns(name + "_ratio", "", meaning + ", with / without", endings));
    return within(part, columns);
}

const DeformerSpec& pbs_of(const Scene& scene)
{
    const DeformerSpec* pbs = find_deformer_with<pbs::PbsOptions>(scene);
    if (!pbs) throw std::logic_error("a scene without PBS");
    return *pbs;
}

// Seconds before the first frame.
double start_of(const nlohmann::json& seconds)
{
    double sum = seconds.value("error_bar_set_up", 0.0);  // only a reference with an error bar has it
    for (const char* part : {"character", "motion", "set_up", "metrics_set_up"}) sum += seconds.at(part).get<double>();
    return sum;
}

}  // namespace

using Rows = Columns<FeatureRow>;
const Rows feature_columns =
    Rows{{"scene", &FeatureRow::scene, "", "name of the run"},
         {"feature", &FeatureRow::feature, "", "what the second scene of the pair has"},
         {"rounds", &FeatureRow::rounds, "", "runs of each scene"}} +
    pair_columns(&FeatureRow::frame_ms, "frame_ms", "ms", "wall time per frame, everything included") +
    pair_columns(&FeatureRow::frame_cpu_ms, "frame_cpu_ms", "ms", "processor time of all threads per frame, everything included") +
    pair_columns(&FeatureRow::step_ms, "step_ms", "ms", "wall time of PBS's step") +
    pair_columns(&FeatureRow::step_cpu_ms, "step_cpu_ms", "ms", "processor time of PBS's step") +
    pair_columns(&FeatureRow::start_s, "start_s", "s", "wall time before the first frame") +
    pair_columns(&FeatureRow::peak_mb, "peak_mb", "MB", "peak memory, 10^6 bytes") +
    Rows{{"shared_objects_without", &FeatureRow::shared_objects_without, "", "loaded libraries, without"},
         {"shared_objects_with", &FeatureRow::shared_objects_with, "", "loaded libraries, with"}} +
    within(&FeatureRow::change,
           Columns<ResultChange>{
               {"largest_distance_m", &ResultChange::distance_m, "m", "largest distance of a vertex between the two results"},
               {"volume_difference_pct", &ResultChange::volume_difference_pct, "%", "largest difference of the two volume changes"}});

nlohmann::json to_json(const FeaturesCase& of)
{
    static const auto fields = OptionFields<FeaturesCase>("features")
                                   .record("name", &FeaturesCase::name)
                                   .record("scene", &FeaturesCase::scene)
                                   .record("cut", &FeaturesCase::cut)
                                   .record("has_surface", &FeaturesCase::has_surface)
                                   .record("rounds", &FeaturesCase::rounds)
                                   .complete();
    return fields.json(of);
}

Compared compare(const std::vector<double>& without, const std::vector<double>& with)
{
    const Spread ratio = spread_of_ratios(with, without);
    return {spread_of(without), spread_of(with), ratio};
}

std::vector<double> costs_of_run(const nlohmann::json& run, const Scene& scene)
{
    const nlohmann::json& cost = run.at("cost");
    const double ms_per_frame = 1e3 / run.at("outcome").at("frames").get<double>();
    const auto frame_and_step = [&](const nlohmann::json& seconds) {
        const double frames = seconds.at("total").get<double>() - start_of(seconds);
        const double step = seconds.at("deformers").at(pbs_of(scene).label).at("step");
        return std::pair(ms_per_frame * frames, ms_per_frame * step);
    };
    const auto [frame_ms, step_ms] = frame_and_step(cost.at("seconds"));
    const auto [frame_cpu_ms, step_cpu_ms] = frame_and_step(cost.at("cpu_seconds"));
    return {
        frame_ms, frame_cpu_ms, step_ms, step_cpu_ms, start_of(cost.at("seconds")), cost.at("peak_memory_mb"), cost.at("shared_objects")};
}

FeatureRow feature_row(const std::string& scene, const std::string& feature, const Samples& without, const Samples& with,
                       const std::optional<ResultChange>& change)
{
    FeatureRow row;
    row.scene = scene;
    row.feature = feature;
    row.change = change;
    std::size_t cost = 0;
    for (Compared FeatureRow::*part : compared_costs) row.*part = compare(without.at(cost), with.at(cost)), ++cost;
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
    const auto before = make_deformer(pbs_of(without)), after = make_deformer(pbs_of(with));
    before->reset(character);
    after->reset(character);
    ResultChange change;
    for (const pbs::Pose& pose : motion.steps) {
        before->advance(pose, motion.time_step_s);
        after->advance(pose, motion.time_step_s);
        const double distance = (before->positions() - after->positions()).rowwise().norm().maxCoeff();
        const double volume =
            mesh_metrics.measure(before->positions()).volume_change_pct - mesh_metrics.measure(after->positions()).volume_change_pct;
        change.distance_m = std::max(change.distance_m, distance);
        change.volume_difference_pct = std::max(change.volume_difference_pct, std::abs(volume));
    }
    return change;
}

}  // namespace experiments

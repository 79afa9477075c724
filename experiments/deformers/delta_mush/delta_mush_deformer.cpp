// LBS, then delta mush.
#include "experiments/deformers/own_weights.hpp"
#include "experiments/deformers/precision_names.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/settings/option_fields.hpp"
#include "pbs/geometry/stopwatch.hpp"
#include "pbs/skinning/packed_delta_mush.hpp"

#include <optional>

namespace experiments {
namespace {

const OptionFields<pbs::DeltaMushOptions>& delta_mush_fields()
{
    static const OptionFields<pbs::DeltaMushOptions> fields =
        OptionFields<pbs::DeltaMushOptions>("delta_mush")
            .add("iterations", &pbs::DeltaMushOptions::iterations,
                 {.lowest = 0, .highest = 1e6, .meaning = "iterations of Laplacian smoothing"})
            .add("step", &pbs::DeltaMushOptions::step,
                 {.lowest = 0, .highest = 1, .meaning = "share of the way to the neighbours' mean in each"})
            .add("precision", &pbs::DeltaMushOptions::precision, {.meaning = "f64: plain code in double; f32: packed code in float"});
    return fields;
}

// Mush: pbs::DeltaMush with double, pbs::PackedDeltaMush with float.
template <class Scalar, class Mush>
class DeltaMushDeformer : public Deformer {
public:
    explicit DeltaMushDeformer(const pbs::DeltaMushOptions& options) : options_(options) {}

    void reset(const pbs::Character& character) override
    {
        skinning_.emplace(character.mesh.rest, character.weights);
        mush_.emplace(character.mesh, options_);
        positions_ = character.mesh.rest;
    }

    pbs::StepSummary advance(const pbs::Pose& pose, double /*dt_s*/) override
    {
        const pbs::Stopwatch stopwatch;
        if constexpr (std::is_same_v<Mush, pbs::DeltaMush>) {
            skinning_->linear(pose, lbs_);
            mush_->apply(lbs_, positions_);
        } else {
            mush_->apply(*skinning_, pose, positions_);
        }
        pbs::StepSummary summary;
        summary.seconds = stopwatch.seconds();
        summary.work.vertex_visits = (options_.iterations + 2) * positions_.rows();  // blended, smoothed, rotated
        if (!positions_.allFinite()) summary.outcome = pbs::Outcome::not_finite;
        return summary;
    }

    const pbs::Positions& positions() const override { return positions_; }

private:
    pbs::DeltaMushOptions options_;
    std::optional<pbs::BlendSkinning<Scalar>> skinning_;
    std::optional<Mush> mush_;
    pbs::Positions lbs_, positions_;
};

std::unique_ptr<Deformer> make_delta_mush(const DeformerSpec& spec)
{
    const auto& options = options_of<pbs::DeltaMushOptions>(spec);
    if (options.precision == pbs::Precision::f32) return std::make_unique<DeltaMushDeformer<float, pbs::PackedDeltaMush<float>>>(options);
    return std::make_unique<DeltaMushDeformer<double, pbs::DeltaMush>>(options);
}

std::vector<SceneKey> delta_mush_keys()
{
    std::vector<SceneKey> keys = delta_mush_fields().keys();
    keys.push_back(own_weights_key("delta_mush"));
    return keys;
}

void read_delta_mush(const SceneValues& values, const std::string& table, DeformerSpec& spec)
{
    spec.options = delta_mush_fields().read(values, table);
    read_own_weights(values, table, spec);
}

}  // namespace

DeformerKind delta_mush_kind()
{
    return {.name = "delta_mush",
            .meaning = "LBS, smoothed, to which the detail of the rest shape is added again (Mancewicz 2014): geometry alone",
            .make = make_delta_mush,
            .options = pbs::DeltaMushOptions{},
            .keys = delta_mush_keys(),
            .read = read_delta_mush,
            .options_json = [](const DeformerSpec& spec) { return delta_mush_fields().json(options_of<pbs::DeltaMushOptions>(spec)); },
            .traits = [](const DeformerSpec& spec) -> DeformerTraits {
                const pbs::Precision precision = options_of<pbs::DeltaMushOptions>(spec).precision;
                return {.precision = name_of(precision), .packed = precision == pbs::Precision::f32};
            }};
}

}  // namespace experiments

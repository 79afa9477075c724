// Direct delta mush, variant 0: all smoothing at reset, one blend and one rotation per vertex in a pose.
#include "experiments/deformers/own_weights.hpp"
#include "experiments/deformers/direct_delta_mush/mush_smoothing_names.hpp"
#include "experiments/deformers/precision_names.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/settings/option_fields.hpp"
#include "pbs/geometry/stopwatch.hpp"
#include "pbs/skinning/packed_direct_mush.hpp"

#include <optional>

namespace experiments {

namespace {

using pbs::DirectDeltaMushOptions;

const OptionFields<DirectDeltaMushOptions>& direct_delta_mush_fields()
{
    static const OptionFields<DirectDeltaMushOptions> fields =
        OptionFields<DirectDeltaMushOptions>("direct_delta_mush")
            .add("iterations", &DirectDeltaMushOptions::iterations,
                 {.lowest = 0, .highest = 1e4, .meaning = "p, steps of Laplacian smoothing before the first pose; 0: LBS"})
            .add("lambda", &DirectDeltaMushOptions::lambda,
                 {.lowest = 0,
                  .highest = 1e4,
                  .meaning = "size of a step for the rotations and, with the share 1 - alpha, the translations; explicit: at most 1"})
            .add(
                "kappa", &DirectDeltaMushOptions::kappa,
                {.lowest = 0, .highest = 1e4, .meaning = "size of a step for the weights of the translations' share alpha; at most lambda"})
            .add("alpha", &DirectDeltaMushOptions::alpha,
                 {.lowest = 0,
                  .highest = 1,
                  .meaning = "0: centres move as in delta mush; 1: they move by LBS with weights smoothed by kappa"})
            .add("negligible", &DirectDeltaMushOptions::negligible,
                 {.lowest = 0, .highest = 1e-3, .meaning = "smoothed weight below which a bone is dropped from a vertex"})
            .add("smoothing", &DirectDeltaMushOptions::smoothing,
                 {.meaning = "implicit: (1 + lambda L)^-p as in the paper; explicit: (1 - lambda L)^p as in delta mush"})
            .add("precision", &DirectDeltaMushOptions::precision, {.meaning = "f64: plain code in double; f32: packed code in float"});
    return fields;
}

// Mush: pbs::DirectDeltaMush, or pbs::PackedDirectMush<float>.
template <class Mush>
class DirectDeltaMushDeformer : public Deformer {
public:
    explicit DirectDeltaMushDeformer(const DirectDeltaMushOptions& options) : options_(options) {}

    void reset(const pbs::Character& character) override
    {
        mush_.emplace(character.mesh, character.weights, options_);
        positions_ = character.mesh.rest;
    }

    pbs::StepSummary advance(const pbs::Pose& pose, double /*dt_s*/) override
    {
        const pbs::Stopwatch stopwatch;
        mush_->apply(pose, positions_);
        pbs::StepSummary summary;
        summary.work.vertex_visits = positions_.rows();
        summary.seconds = stopwatch.seconds();
        if (!positions_.allFinite()) summary.outcome = pbs::Outcome::not_finite;
        return summary;
    }

    const pbs::Positions& positions() const override { return positions_; }

private:
    DirectDeltaMushOptions options_;
    std::optional<Mush> mush_;
    pbs::Positions positions_;
};

std::unique_ptr<Deformer> make_direct_delta_mush(const DeformerSpec& spec)
{
    const auto& options = options_of<DirectDeltaMushOptions>(spec);
    if (options.precision == pbs::Precision::f32) return std::make_unique<DirectDeltaMushDeformer<pbs::PackedDirectMush<float>>>(options);
    return std::make_unique<DirectDeltaMushDeformer<pbs::DirectDeltaMush>>(options);
}

std::vector<SceneKey> direct_delta_mush_keys()
{
    std::vector<SceneKey> keys = direct_delta_mush_fields().keys();
    keys.push_back(own_weights_key("direct_delta_mush"));
    return keys;
}

void read_direct_delta_mush(const SceneValues& values, const std::string& table, DeformerSpec& spec)
{
    const DirectDeltaMushOptions options = direct_delta_mush_fields().read(values, table);
    if (options.kappa > options.lambda) values.refuse(table + ".kappa", "expected at most lambda");
    if (options.smoothing == pbs::MushSmoothing::explicit_steps && options.lambda > 1.0)
        values.refuse(table + ".lambda", "expected at most 1 with explicit smoothing");
    spec.options = options;
    read_own_weights(values, table, spec);
}

}  // namespace

DeformerKind direct_delta_mush_kind()
{
    return {
        .name = "direct_delta_mush",
        .meaning = "delta mush whose smoothing is done once, in the rest pose (Le and Lewis 2019, variant 0)",
        .make = make_direct_delta_mush,
        .options = DirectDeltaMushOptions{},
        .keys = direct_delta_mush_keys(),
        .read = read_direct_delta_mush,
        .options_json = [](const DeformerSpec& spec) { return direct_delta_mush_fields().json(options_of<DirectDeltaMushOptions>(spec)); },
        .traits = [](const DeformerSpec& spec) -> DeformerTraits {
            const pbs::Precision precision = options_of<DirectDeltaMushOptions>(spec).precision;
            return {.precision = name_of(precision), .packed = precision == pbs::Precision::f32};
        }};
}

}  // namespace experiments

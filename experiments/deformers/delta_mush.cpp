// LBS, then delta mush.

#include "experiments/deformers/deformer_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/settings/option_fields.hpp"
#include "pbs/geometry/cost.hpp"
#include "pbs/skinning/delta_mush.hpp"
#include "pbs/skinning/direct_delta_mush.hpp"

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

// Direct delta mush, variant 0: all smoothing at reset, one blend and one rotation per vertex in a pose.

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

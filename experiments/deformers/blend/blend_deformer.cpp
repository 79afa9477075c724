// LBS and DQS as deformers: no state but the last pose's positions. They blend with the scene's weights; a table [[lbs]] or [[dqs]] adds
// one with weights of its own.
#include "experiments/deformers/registry.hpp"
#include "experiments/settings/scene_values.hpp"
#include "pbs/character/skinning_weights.hpp"
#include "pbs/geometry/stopwatch.hpp"
#include "pbs/skinning/blend_skinning.hpp"

#include <array>
#include <optional>

namespace experiments {
namespace {

struct BlendOptions {
    std::optional<pbs::WeightKind> weights;  // null: the scene's
};

constexpr std::array<pbs::WeightKind, 4> own_weights = {pbs::WeightKind::paper, pbs::WeightKind::rigid, pbs::WeightKind::smooth,
                                                        pbs::WeightKind::artist};

class BlendDeformer : public Deformer {
public:
    using Blend = void (pbs::BlendSkinning<double>::*)(const pbs::Pose& pose, pbs::Positions& posed);
    BlendDeformer(Blend blend, const BlendOptions& options) : blend_(blend), options_(options) {}

    void reset(const pbs::Character& character) override
    {
        skinning_.emplace(character.mesh.rest, options_.weights ? pbs::weights_by(*options_.weights, character) : character.weights);
        positions_ = character.mesh.rest;
    }

    pbs::StepSummary advance(const pbs::Pose& pose, double /*dt_s*/) override
    {
        const pbs::Stopwatch stopwatch;
        ((*skinning_).*blend_)(pose, positions_);
        pbs::StepSummary summary;
        summary.seconds = stopwatch.seconds();
        if (!positions_.allFinite()) summary.outcome = pbs::Outcome::not_finite;
        return summary;
    }

    const pbs::Positions& positions() const override { return positions_; }

private:
    Blend blend_;
    BlendOptions options_;
    std::optional<pbs::BlendSkinning<double>> skinning_;
    pbs::Positions positions_;
};

std::vector<SceneKey> blend_keys(const std::string& kind)
{
    std::vector<std::string> choices;
    for (const pbs::WeightKind weights : own_weights) choices.push_back(pbs::name_of(weights));
    return {{.table = kind,
             .name = "name",
             .type = KeyType::text,
             .meaning = "the name of this deformer in deformers.use and in the records",
             .in_list = true},
            {.table = kind,
             .name = "weights",
             .type = KeyType::text,
             .choices = choices,
             .meaning = "the weights that it blends with, instead of skinning.weights",
             .in_list = true}};
}

void read_blend(const SceneValues& values, const std::string& table, DeformerSpec& spec)
{
    if (table == spec.kind) return;  // not from a list: the scene's weights
    const std::string weights = values.text(table + ".weights");
    for (const pbs::WeightKind kind : own_weights)
        if (weights == pbs::name_of(kind)) spec.options = BlendOptions{kind};
    spec.variant = "weights_" + weights;
}

nlohmann::json blend_json(const DeformerSpec& spec)
{
    const auto& weights = options_of<BlendOptions>(spec).weights;
    return {{"weights", weights ? pbs::name_of(*weights) : "of the scene"}};
}

DeformerTraits lbs_traits(const DeformerSpec& /*spec*/)
{
    return {.blends_linearly = true};
}

// Rest positions in and posed positions out. Operations are not counted.
IterationWork work_of_blend(const DeformerSpec& /*spec*/, const BodyCounts& body)
{
    const double bytes = 2.0 * 3.0 * sizeof(double) * body.vertices;
    return {.bytes = bytes, .working_set_bytes = bytes};
}

DeformerKind blend_kind(const std::string& name, const std::string& meaning, std::unique_ptr<Deformer> (*make)(const DeformerSpec& spec))
{
    return {.name = name,
            .meaning = meaning,
            .make = make,
            .options = BlendOptions{},
            .keys = blend_keys(name),
            .has_list = true,
            .read = read_blend,
            .options_json = blend_json,
            .work = work_of_blend};
}

}  // namespace

DeformerKind lbs_kind()
{
    DeformerKind kind = blend_kind("lbs", "linear blend skinning, Eq. 1", [](const DeformerSpec& spec) -> std::unique_ptr<Deformer> {
        return std::make_unique<BlendDeformer>(&pbs::BlendSkinning<double>::linear, options_of<BlendOptions>(spec));
    });
    kind.traits = lbs_traits;
    return kind;
}

DeformerKind dqs_kind()
{
    return blend_kind(
        "dqs", "dual quaternion skinning (Kavan 2007), the paper's comparison", [](const DeformerSpec& spec) -> std::unique_ptr<Deformer> {
            return std::make_unique<BlendDeformer>(&pbs::BlendSkinning<double>::dual_quaternion, options_of<BlendOptions>(spec));
        });
}

}  // namespace experiments

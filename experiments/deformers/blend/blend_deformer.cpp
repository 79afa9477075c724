// LBS and DQS as deformers: no state but the last pose's positions. They blend with the scene's weights; a table [[lbs]] or [[dqs]] adds
// one with weights or a precision of its own.
#include "experiments/deformers/blend/blend_options.hpp"
#include "experiments/deformers/own_weights.hpp"
#include "experiments/deformers/precision_names.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/settings/option_fields.hpp"
#include "pbs/character/skinning_weights.hpp"
#include "pbs/geometry/stopwatch.hpp"
#include "pbs/skinning/blend_skinning.hpp"
#include "pbs/skinning/skinning_work.hpp"

#include <optional>

namespace experiments {
namespace {

enum class Blend { linear, dual_quaternion };

template <class Scalar>
class BlendDeformer : public Deformer {
public:
    explicit BlendDeformer(Blend blend) : blend_(blend) {}

    void reset(const pbs::Character& character) override
    {
        skinning_.emplace(character.mesh.rest, character.weights);
        positions_ = character.mesh.rest;
    }

    pbs::StepSummary advance(const pbs::Pose& pose, double /*dt_s*/) override
    {
        const pbs::Stopwatch stopwatch;
        if (blend_ == Blend::linear)
            skinning_->linear(pose, positions_);
        else
            skinning_->dual_quaternion(pose, positions_);
        pbs::StepSummary summary;
        summary.seconds = stopwatch.seconds();
        summary.work.vertex_visits = positions_.rows();
        if (!positions_.allFinite()) summary.outcome = pbs::Outcome::not_finite;
        return summary;
    }

    const pbs::Positions& positions() const override { return positions_; }
    pbs::KeptEntries kept() const override
    {
        if (!skinning_) return {};
        const auto& own = skinning_->packed_weights().own;
        return {double(own.bone.size()), double(own.rows())};
    }

private:
    Blend blend_;
    std::optional<pbs::BlendSkinning<Scalar>> skinning_;
    pbs::Positions positions_;
};

std::unique_ptr<Deformer> make_blend(Blend blend, const DeformerSpec& spec)
{
    if (options_of<BlendOptions>(spec).precision == pbs::Precision::f32) return std::make_unique<BlendDeformer<float>>(blend);
    return std::make_unique<BlendDeformer<double>>(blend);
}

OptionFields<BlendOptions> blend_fields(const std::string& kind)
{
    return OptionFields<BlendOptions>(kind, true).add("precision", &BlendOptions::precision, {.meaning = "floating point of the blend"});
}

std::vector<SceneKey> blend_keys(const std::string& kind)
{
    std::vector<SceneKey> keys = blend_fields(kind).keys();
    keys.insert(keys.begin(), {{.table = kind,
                                .name = "name",
                                .type = KeyType::text,
                                .meaning = "the name of this deformer in deformers.use and in the records",
                                .in_list = true},
                               own_weights_key(kind, true)});
    return keys;
}

void read_blend(const SceneValues& values, const std::string& table, DeformerSpec& spec)
{
    if (table == spec.kind) return;  // not from a list: the scene's weights, in double
    spec.options = blend_fields(spec.kind).read(values, table);
    read_own_weights(values, table, spec);
}

nlohmann::json blend_json(const DeformerSpec& spec)
{
    nlohmann::json json = blend_fields(spec.kind).json(options_of<BlendOptions>(spec));
    json["weights"] = spec.weights ? pbs::name_of(*spec.weights) : "of the scene";
    return json;
}

DeformerTraits blend_traits(const DeformerSpec& spec)
{
    return {.precision = name_of(options_of<BlendOptions>(spec).precision), .packed = true};
}

DeformerTraits lbs_traits(const DeformerSpec& spec)
{
    DeformerTraits traits = blend_traits(spec);
    traits.blends_linearly = true;
    return traits;
}

template <IterationWork (*work_of)(const BodyCounts& body, double scalar_bytes)>
IterationWork work_of_blend(const DeformerSpec& spec, const BodyCounts& body)
{
    return work_of(body, options_of<BlendOptions>(spec).precision == pbs::Precision::f32 ? sizeof(float) : sizeof(double));
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
            .traits = blend_traits,
            .work = work_of_blend<pbs::work_of_dual_quaternion_blend>};
}

}  // namespace

DeformerKind lbs_kind()
{
    DeformerKind kind =
        blend_kind("lbs", "linear blend skinning, Eq. 1", [](const DeformerSpec& spec) { return make_blend(Blend::linear, spec); });
    kind.traits = lbs_traits;
    kind.work = work_of_blend<pbs::work_of_linear_blend>;
    return kind;
}

DeformerKind dqs_kind()
{
    return blend_kind("dqs", "dual quaternion skinning (Kavan 2007), the paper's comparison",
                      [](const DeformerSpec& spec) { return make_blend(Blend::dual_quaternion, spec); });
}

}  // namespace experiments

// LBS and DQS as deformers: no state but the last pose's positions. They blend with the scene's weights; a table [[lbs]] or [[dqs]] adds
// one with weights, a precision or a code of its own.
#include "experiments/deformers/deformer_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/settings/option_fields.hpp"
#include "pbs/character/skinning_weights.hpp"
#include "pbs/geometry/cost.hpp"
#include "pbs/skinning/blend.hpp"

#include <optional>

namespace experiments {
namespace {

enum class Blend { linear, dual_quaternion };

class BlendingDeformer : public Deformer {
public:
    void reset(const pbs::Character& character) final
    {
        set_up(character);
        positions_ = character.mesh.rest;
    }

    pbs::StepSummary advance(const pbs::Pose& pose, double /*dt_s*/) final
    {
        const pbs::Stopwatch stopwatch;
        blend(pose, positions_);
        pbs::StepSummary summary;
        summary.seconds = stopwatch.seconds();
        summary.work.vertex_visits = positions_.rows();
        if (!positions_.allFinite()) summary.outcome = pbs::Outcome::not_finite;
        return summary;
    }

    const pbs::Positions& positions() const final { return positions_; }

private:
    virtual void set_up(const pbs::Character& character) = 0;
    virtual void blend(const pbs::Pose& pose, pbs::Positions& posed) = 0;

    pbs::Positions positions_;
};

template <class Scalar>
class PackedBlend : public BlendingDeformer {
public:
    explicit PackedBlend(Blend blend) : blend_(blend) {}

private:
    void set_up(const pbs::Character& character) override { skinning_.emplace(character.mesh.rest, character.weights); }
    void blend(const pbs::Pose& pose, pbs::Positions& posed) override
    {
        if (blend_ == Blend::linear)
            skinning_->linear(pose, posed);
        else
            skinning_->dual_quaternion(pose, posed);
    }

    Blend blend_;
    std::optional<pbs::BlendSkinning<Scalar>> skinning_;
};

class PlainBlend : public BlendingDeformer {
public:
    explicit PlainBlend(Blend blend) : blend_(blend) {}

private:
    void set_up(const pbs::Character& character) override { character_ = &character; }
    void blend(const pbs::Pose& pose, pbs::Positions& posed) override
    {
        const auto blended = blend_ == Blend::linear ? pbs::linear_blend_skinning : pbs::dual_quaternion_skinning;
        blended(character_->mesh.rest, character_->weights, pose, posed);
    }

    Blend blend_;
    const pbs::Character* character_ = nullptr;
};

std::unique_ptr<Deformer> make_blend(Blend blend, const DeformerSpec& spec)
{
    const auto& options = options_of<BlendOptions>(spec);
    if (!options.packed) return std::make_unique<PlainBlend>(blend);
    if (options.precision == pbs::Precision::f32) return std::make_unique<PackedBlend<float>>(blend);
    return std::make_unique<PackedBlend<double>>(blend);
}

OptionFields<BlendOptions> blend_fields(const std::string& kind)
{
    return OptionFields<BlendOptions>(kind, true)
        .add("precision", &BlendOptions::precision, {.meaning = "floating point of the blend"})
        .add("packed", &BlendOptions::packed,
             {.meaning = "weights that several vertices have are blended once per pose; false: plain code in f64, one vertex at a time"});
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
    const BlendOptions options = blend_fields(spec.kind).read(values, table);
    if (!options.packed && options.precision == pbs::Precision::f32)
        values.refuse(table + ".packed", "expected true with precision = \"f32\": the plain code is in f64");
    spec.options = options;
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
    const auto& options = options_of<BlendOptions>(spec);
    return {.precision = name_of(options.precision), .packed = options.packed};
}

DeformerTraits lbs_traits(const DeformerSpec& spec)
{
    DeformerTraits traits = blend_traits(spec);
    traits.blends_linearly = true;
    return traits;
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
            .traits = blend_traits};
}

}  // namespace

DeformerKind lbs_kind()
{
    DeformerKind kind =
        blend_kind("lbs", "linear blend skinning, Eq. 1", [](const DeformerSpec& spec) { return make_blend(Blend::linear, spec); });
    kind.traits = lbs_traits;
    return kind;
}

DeformerKind dqs_kind()
{
    return blend_kind("dqs", "dual quaternion skinning (Kavan 2007), the paper's comparison",
                      [](const DeformerSpec& spec) { return make_blend(Blend::dual_quaternion, spec); });
}

}  // namespace experiments

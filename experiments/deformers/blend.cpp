// LBS and DQS, and delta mush, which smooths LBS: no state but the last pose's positions. LBS and DQS blend with the
// scene's weights; a table [[lbs]] or [[dqs]] adds one with weights, a precision or a code of its own.
#include "experiments/characters/skinning_weights.hpp"
#include "experiments/deformers/deformer_kind.hpp"
#include "pbs/skinning/blend.hpp"
#include "pbs/skinning/delta_mush.hpp"
#include "pbs/skinning/direct_delta_mush.hpp"

#include <optional>
#include <type_traits>

namespace experiments {
namespace {

using pbs::DeltaMushOptions;
using pbs::DirectDeltaMushOptions;

enum class Blend { linear, dual_quaternion };

pbs::StepSummary visited(Eigen::Index vertices)
{
    return {.work = {.vertex_visits = vertices}};
}

// Plain<...> for the options' plain code, Packed<double> or Packed<float> otherwise.
template <typename Plain, template <typename> class Packed, typename... Arguments>
std::unique_ptr<Deformer> in_code(pbs::Precision precision, bool packed, const Arguments&... arguments)
{
    if (!packed) return std::make_unique<Plain>(arguments...);
    if (precision == pbs::Precision::f32) return std::make_unique<Packed<float>>(arguments...);
    return std::make_unique<Packed<double>>(arguments...);
}

template <class Scalar>
class PackedBlend : public TimedDeformer {
public:
    explicit PackedBlend(Blend blend) : blend_(blend) {}

private:
    void set_up(const pbs::Character& character) override { skinning_.emplace(character.mesh.rest, character.weights); }
    pbs::StepSummary deform(const pbs::Pose& pose, double /*dt_s*/, pbs::Positions& x) override
    {
        if (blend_ == Blend::linear)
            skinning_->linear(pose, x);
        else
            skinning_->dual_quaternion(pose, x);
        return visited(x.rows());
    }

    Blend blend_;
    std::optional<pbs::BlendSkinning<Scalar>> skinning_;
};

class PlainBlend : public TimedDeformer {
public:
    explicit PlainBlend(Blend blend) : blend_(blend) {}

private:
    void set_up(const pbs::Character& character) override { character_ = &character; }
    pbs::StepSummary deform(const pbs::Pose& pose, double /*dt_s*/, pbs::Positions& x) override
    {
        const auto blended = blend_ == Blend::linear ? pbs::linear_blend_skinning : pbs::dual_quaternion_skinning;
        blended(character_->mesh.rest, character_->weights, pose, x);
        return visited(x.rows());
    }

    Blend blend_;
    const pbs::Character* character_ = nullptr;
};

// Mush: pbs::DeltaMush, or pbs::PackedDeltaMush<Scalar>.
template <class Scalar, class Mush>
class DeltaMushDeformer : public TimedDeformer {
public:
    explicit DeltaMushDeformer(const DeltaMushOptions& options) : options_(options) {}

private:
    void set_up(const pbs::Character& character) override
    {
        skinning_.emplace(character.mesh.rest, character.weights);
        mush_.emplace(character.mesh, options_);
    }
    pbs::StepSummary deform(const pbs::Pose& pose, double /*dt_s*/, pbs::Positions& x) override
    {
        if constexpr (std::is_same_v<Mush, pbs::DeltaMush>) {
            skinning_->linear(pose, lbs_);
            mush_->apply(lbs_, x);
        } else {
            mush_->apply(*skinning_, pose, x);
        }
        return visited((options_.iterations + 2) * x.rows());  // blended, smoothed, rotated
    }

    DeltaMushOptions options_;
    std::optional<pbs::BlendSkinning<Scalar>> skinning_;
    std::optional<Mush> mush_;
    pbs::Positions lbs_;
};

template <class Scalar>
using PackedMushDeformer = DeltaMushDeformer<Scalar, pbs::PackedDeltaMush<Scalar>>;

// Variant 0: all smoothing at reset, one blend and one rotation per vertex in a pose. Mush: pbs::DirectDeltaMush, or
// pbs::PackedDirectMush<Scalar>.
template <class Mush>
class DirectDeltaMushDeformer : public TimedDeformer {
public:
    explicit DirectDeltaMushDeformer(const DirectDeltaMushOptions& options) : options_(options) {}

private:
    void set_up(const pbs::Character& character) override
    {
        mush_.emplace(character.mesh, character.weights, options_);
    }
    pbs::StepSummary deform(const pbs::Pose& pose, double /*dt_s*/, pbs::Positions& x) override
    {
        mush_->apply(pose, x);
        return visited(x.rows());
    }

    DirectDeltaMushOptions options_;
    std::optional<Mush> mush_;
};

template <class Scalar>
using PackedDirectMushDeformer = DirectDeltaMushDeformer<pbs::PackedDirectMush<Scalar>>;

// The weights of DeformerSpec::weights, by the key `weights` of a deformer's table.
template <typename Options>
OptionFields<Options>& add_weights_key(OptionFields<Options>& fields)
{
    std::vector<std::string> choices = {"scene"};
    for (const char* name : pbs::weight_names)
        if (pbs::weights_named(name)) choices.emplace_back(name);
    fields.key("weights", KeyType::text, "scene",
               {.choices = choices, .meaning = "the weights that it blends with; scene: those of skinning.weights"});
    return fields;
}

// Sets the weights and, unless they are the scene's, the variant: weights_smooth.
template <typename Options>
void read_weights(const SceneValues& values, const std::string& table, Options& /*options*/, DeformerSpec& spec)
{
    const std::string weights = values.text(table + ".weights");
    spec.weights = pbs::weights_named(weights);
    if (spec.weights) spec.variant = "weights_" + weights;
}

template <Blend blend>
DeformerKind blend_kind(const std::string& name, const std::string& meaning)
{
    OptionFields<BlendOptions> fields(name, true);
    fields.key("name", KeyType::text, "",
               {.is_stated = true, .meaning = "the name of this deformer in deformers.use and in the records"});
    add_weights_key(fields)
        .add("precision", &BlendOptions::precision, {.meaning = "floating point of the blend"})
        .add("packed", &BlendOptions::packed,
             {.meaning = "weights that several vertices have are blended once per pose; false: plain code in f64, one "
                         "vertex at a time"});
    DeformerKind kind = kind_of<void>(name, meaning, fields.complete(), read_weights<BlendOptions>);
    kind.make = [](const DeformerSpec& spec) {
        const auto& options = options_of<BlendOptions>(spec);
        return in_code<PlainBlend, PackedBlend>(options.precision, options.packed, blend);
    };
    kind.options_json = [fields](const DeformerSpec& spec) {
        nlohmann::json json = fields.json(options_of<BlendOptions>(spec));
        json["weights"] = spec.weights ? pbs::name_of(*spec.weights) : "of the scene";
        return json;
    };
    if (blend == Blend::linear)
        kind.traits = [](const DeformerSpec& spec) {
            DeformerTraits traits = traits_from(options_of<BlendOptions>(spec), spec);
            traits.blends_linearly = true;
            return traits;
        };
    return kind;
}

template <typename Options, typename Plain, template <typename> class Packed>
DeformerKind mush_kind(const std::string& name, const std::string& meaning, OptionFields<Options>& fields,
                       CheckOptions<Options> check = read_weights<Options>)
{
    fields.add("precision", &Options::precision, {.meaning = "floating point of the smoothing; f32: packed code"})
        .add("packed", &Options::packed,
             {.meaning = "true: several vertices per instruction; false: plain code in f64"});
    DeformerKind kind = kind_of<void>(name, meaning, add_weights_key(fields).complete(), check);
    kind.make = [](const DeformerSpec& spec) {
        const auto& options = options_of<Options>(spec);
        return in_code<Plain, Packed>(options.precision, options.packed, options);
    };
    return kind;
}

void check_direct_mush(const SceneValues& values, const std::string& table, DirectDeltaMushOptions& options,
                       DeformerSpec& spec)
{
    read_weights(values, table, options, spec);
    if (options.kappa > options.lambda) values.refuse(table + ".kappa", "expected at most lambda");
    if (options.smoothing == pbs::MushSmoothing::explicit_steps && options.lambda > 1.0)
        values.refuse(table + ".lambda", "expected at most 1 with explicit smoothing");
}

}  // namespace

DeformerKind lbs_kind()
{
    return blend_kind<Blend::linear>("lbs", "linear blend skinning, Eq. 1");
}

DeformerKind dqs_kind()
{
    return blend_kind<Blend::dual_quaternion>("dqs", "dual quaternion skinning (Kavan 2007), the paper's comparison");
}

DeformerKind delta_mush_kind()
{
    OptionFields<DeltaMushOptions> fields("delta_mush");
    fields
        .add("iterations", &DeltaMushOptions::iterations,
             {.range = {0, 1e6}, .meaning = "iterations of Laplacian smoothing"})
        .add("step", &DeltaMushOptions::step,
             {.range = {0, 1}, .meaning = "share of the way to the neighbours' mean in each"})
        .add("unsmoothed_share", &DeltaMushOptions::unsmoothed_share,
             {.range = {0, 1},
              .meaning = "share of the edges before smoothing in the frames that carry the detail; 0: the smoothed "
                         "edges alone, as "
                         "published, which turn limbs that are a few tets thick inside out. `pbskin try` takes 0.01"});
    return mush_kind<DeltaMushOptions, DeltaMushDeformer<double, pbs::DeltaMush>, PackedMushDeformer>(
        "delta_mush",
        "LBS, smoothed, to which the detail of the rest shape is added again (Mancewicz 2014): geometry alone", fields);
}

DeformerKind direct_delta_mush_kind()
{
    using Options = DirectDeltaMushOptions;
    OptionFields<Options> fields("direct_delta_mush");
    fields
        .add("iterations", &Options::iterations,
             {.range = {0, 1e4}, .meaning = "p, steps of Laplacian smoothing before the first pose; 0: LBS"})
        .add("lambda", &Options::lambda,
             {.range = {0, 1e4},
              .meaning = "size of a step for the rotations and, with the share 1 - alpha, the translations; explicit: "
                         "at most 1"})
        .add("kappa", &Options::kappa,
             {.range = {0, 1e4},
              .meaning = "size of a step for the weights of the translations' share alpha; at most lambda"})
        .add("alpha", &Options::alpha,
             {.range = {0, 1},
              .meaning = "0: centres move as in delta mush; 1: they move by LBS with weights smoothed by kappa"})
        .add("negligible", &Options::negligible,
             {.range = {0, 1e-3}, .meaning = "smoothed weight below which a bone is dropped from a vertex"})
        .add("smoothing", &Options::smoothing,
             {.meaning = "implicit: (1 + lambda L)^-p as in the paper; explicit: (1 - lambda L)^p as in delta mush"});
    return mush_kind<Options, DirectDeltaMushDeformer<pbs::DirectDeltaMush>, PackedDirectMushDeformer>(
        "direct_delta_mush", "delta mush whose smoothing is done once, in the rest pose (Le and Lewis 2019, variant 0)",
        fields, check_direct_mush);
}

}  // namespace experiments

#include "experiments/deformers/registry.hpp"

#include "experiments/characters/skinning_weights.hpp"
#include "experiments/deformers/deformer_options.hpp"
#include "pbs/geometry/cost.hpp"

#include <algorithm>
#include <stdexcept>

namespace experiments {
namespace {

std::vector<DeformerKind>& registered()
{
    static std::vector<DeformerKind> kinds = {
        lbs_kind(),
        dqs_kind(),
        delta_mush_kind(),
        direct_delta_mush_kind(),
        correctives_kind(),
        pbs_kind(),
        pbs_author_kind(),
        xpbd_kind(),
        xpbd_small_steps_kind(),
        quasi_newton_kind(),
        vbd_kind(),
        warped_newton_kind(),
        xpbd_neo_hookean_kind(),
        projective_dynamics_kind(),
        fem_kind(),
        external_kind(),
    };
    return kinds;
}

const DeformerKind& kind_named(const std::string& name)
{
    const DeformerKind* kind = find_deformer_kind(name);
    if (!kind) throw std::logic_error("unregistered deformer kind " + name);
    return *kind;
}

// A deformer on a character whose skinning weights follow another rule.
class WeightedDeformer : public WrappingDeformer {
public:
    WeightedDeformer(std::unique_ptr<Deformer> deformer, pbs::WeightKind weights)
        : WrappingDeformer(std::move(deformer)), weights_(weights)
    {
    }

    void reset(const pbs::Character& character) override
    {
        character_ = pbs::with_weights(weights_, character);
        wrapped().reset(character_);
    }

private:
    pbs::WeightKind weights_;
    pbs::Character character_;
};

}  // namespace

const std::vector<DeformerKind>& deformer_kinds()
{
    return registered();
}

void add_deformer_kind(DeformerKind kind)
{
    registered().push_back(std::move(kind));
}

const DeformerKind* find_deformer_kind(const std::string& name)
{
    const auto found = std::ranges::find(deformer_kinds(), name, &DeformerKind::name);
    return found == deformer_kinds().end() ? nullptr : &*found;
}

DeformerSpec default_spec(const std::string& kind)
{
    return {.name = kind, .kind = kind, .label = kind, .options = kind_named(kind).options};
}

std::unique_ptr<Deformer> make_deformer(const DeformerSpec& spec)
{
    std::unique_ptr<Deformer> deformer = kind_named(spec.kind).make(spec);
    return spec.weights ? std::make_unique<WeightedDeformer>(std::move(deformer), *spec.weights) : std::move(deformer);
}

DeformerTraits traits_of(const DeformerSpec& spec)
{
    const DeformerKind& kind = kind_named(spec.kind);
    return kind.traits ? kind.traits(spec) : DeformerTraits{};
}

nlohmann::json to_json(const DeformerSpec& spec)
{
    nlohmann::json json = {{"name", spec.name}, {"label", spec.label}, {"kind", spec.kind}, {"variant", spec.variant}};
    if (const DeformerKind& kind = kind_named(spec.kind); kind.options_json) json["options"] = kind.options_json(spec);
    if (spec.weights) json["weights"] = pbs::name_of(*spec.weights);
    return json;
}

std::vector<bool> near_tips(const std::vector<CreaseTip>& tips, const pbs::Positions& points_at_rest)
{
    std::vector<bool> near(points_at_rest.rows(), false);
    for (Eigen::Index p = 0; p < points_at_rest.rows(); ++p)
        for (const CreaseTip& tip : tips)
            if ((points_at_rest.row(p).transpose() - tip.at_rest).norm() <= tip.radius_m) near[p] = true;
    return near;
}

void TimedDeformer::reset(const pbs::Character& character)
{
    positions_ = character.mesh.rest;
    set_up(character);
}

pbs::StepSummary TimedDeformer::advance(const pbs::Pose& pose, double dt_s)
{
    const pbs::Stopwatch stopwatch;
    pbs::StepSummary summary = deform(pose, dt_s, positions_);
    if (!has_own_clock()) summary.seconds = stopwatch.seconds();
    if (!positions_.allFinite()) summary.outcome = pbs::Outcome::not_finite;
    return summary;
}

void agree_on_code(const SceneValues& values, const std::string& table, pbs::Precision& precision, bool& packed)
{
    if (packed || precision == pbs::Precision::f64) return;
    if (!values.given(table + ".packed"))
        packed = true;
    else if (!values.given(table + ".precision"))
        precision = pbs::Precision::f64;
    else
        values.refuse(table + ".packed", "expected true with precision = \"f32\": the plain code is in f64");
}

}  // namespace experiments

#include "experiments/deformers/registry.hpp"

#include "experiments/deformers/own_weights.hpp"
#include "pbs/character/skinning_weights.hpp"

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
        pbs_kind(),
        pbs_author_kind(),
        xpbd_kind(),
        xpbd_small_steps_kind(),
        quasi_newton_kind(),
        vbd_kind(),
        xpbd_neo_hookean_kind(),
        projective_dynamics_kind(),
        fem_kind(),
        external_kind(),
    };
    return kinds;
}

const DeformerKind& kind_of(const std::string& name)
{
    const DeformerKind* kind = find_deformer_kind(name);
    if (!kind) throw std::logic_error("unregistered deformer kind " + name);
    return *kind;
}

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
    const auto& kinds = deformer_kinds();
    const auto found = std::find_if(kinds.begin(), kinds.end(), [&](const DeformerKind& kind) { return kind.name == name; });
    return found == kinds.end() ? nullptr : &*found;
}

DeformerSpec default_spec(const std::string& kind)
{
    return {.name = kind, .kind = kind, .label = kind, .options = kind_of(kind).options};
}

std::unique_ptr<Deformer> make_deformer(const DeformerSpec& spec)
{
    std::unique_ptr<Deformer> deformer = kind_of(spec.kind).make(spec);
    return spec.weights ? with_own_weights(std::move(deformer), *spec.weights) : std::move(deformer);
}

DeformerTraits traits_of(const DeformerSpec& spec)
{
    const DeformerKind& kind = kind_of(spec.kind);
    return kind.traits ? kind.traits(spec) : DeformerTraits{};
}

nlohmann::json to_json(const DeformerSpec& spec)
{
    nlohmann::json json = {{"name", spec.name}, {"label", spec.label}, {"kind", spec.kind}, {"variant", spec.variant}};
    if (const DeformerKind& kind = kind_of(spec.kind); kind.options_json) json["options"] = kind.options_json(spec);
    if (spec.weights) json["weights"] = pbs::name_of(*spec.weights);
    return json;
}

}  // namespace experiments

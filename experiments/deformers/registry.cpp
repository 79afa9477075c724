#include "experiments/deformers/registry.hpp"

#include "experiments/settings/scene_values.hpp"
#include "pbs/character/skinning_weights.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace experiments {
namespace {

constexpr std::array<pbs::WeightKind, 5> own_weights = {pbs::WeightKind::paper, pbs::WeightKind::rigid, pbs::WeightKind::smooth,
                                                        pbs::WeightKind::diffused, pbs::WeightKind::artist};
constexpr const char* of_the_scene = "scene";

class WeightedDeformer : public Deformer {
public:
    WeightedDeformer(std::unique_ptr<Deformer> deformer, pbs::WeightKind weights) : deformer_(std::move(deformer)), weights_(weights) {}

    void reset(const pbs::Character& character) override
    {
        character_ = pbs::with_weights(weights_, character);
        deformer_->reset(character_);
    }
    pbs::StepSummary advance(const pbs::Pose& pose, double dt_s) override { return deformer_->advance(pose, dt_s); }
    const pbs::Positions& positions() const override { return deformer_->positions(); }
    void foresee(const std::vector<pbs::Pose>& poses) override { deformer_->foresee(poses); }
    void start_from(const pbs::Positions& shape) override { deformer_->start_from(shape); }
    bool has_memory() const override { return deformer_->has_memory(); }
    std::vector<bool> prescribed() const override { return deformer_->prescribed(); }
    FewerNodes set_out_from() const override { return deformer_->set_out_from(); }
    std::optional<double> lowest_det_f() const override { return deformer_->lowest_det_f(); }
    pbs::Positions last_state() const override { return deformer_->last_state(); }
    nlohmann::json record() const override { return deformer_->record(); }

private:
    std::unique_ptr<Deformer> deformer_;
    pbs::WeightKind weights_;
    pbs::Character character_;
};

}  // namespace

std::unique_ptr<Deformer> with_own_weights(std::unique_ptr<Deformer> deformer, pbs::WeightKind weights)
{
    return std::make_unique<WeightedDeformer>(std::move(deformer), weights);
}

SceneKey own_weights_key(const std::string& table, bool in_list)
{
    std::vector<std::string> choices = {of_the_scene};
    for (const pbs::WeightKind weights : own_weights) choices.push_back(pbs::name_of(weights));
    return {.table = table,
            .name = "weights",
            .type = KeyType::text,
            .default_json = '"' + std::string(of_the_scene) + '"',
            .choices = choices,
            .meaning = "the weights that it blends with; scene: those of skinning.weights",
            .in_list = in_list};
}

void read_own_weights(const SceneValues& values, const std::string& table, DeformerSpec& spec)
{
    const std::string weights = values.text(table + ".weights");
    for (const pbs::WeightKind kind : own_weights)
        if (weights == pbs::name_of(kind)) spec.weights = kind;
    if (spec.weights) spec.variant = "weights_" + weights;
}

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

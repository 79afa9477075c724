#include "experiments/deformers/own_weights.hpp"

#include "experiments/settings/scene_values.hpp"
#include "pbs/character/skinning_weights.hpp"

#include <array>

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

}  // namespace experiments

// LBS, then delta mush.
#include "experiments/deformers/registry.hpp"
#include "experiments/settings/option_fields.hpp"
#include "pbs/geometry/stopwatch.hpp"
#include "pbs/skinning/blend_skinning.hpp"
#include "pbs/skinning/delta_mush.hpp"

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
                 {.lowest = 0, .highest = 1, .meaning = "share of the way to the neighbours' mean in each"});
    return fields;
}

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
        skinning_->linear(pose, lbs_);
        mush_->apply(lbs_, positions_);
        pbs::StepSummary summary;
        summary.seconds = stopwatch.seconds();
        summary.work.vertex_visits = (options_.iterations + 2) * positions_.rows();  // blended, smoothed, rotated
        if (!positions_.allFinite()) summary.outcome = pbs::Outcome::not_finite;
        return summary;
    }

    const pbs::Positions& positions() const override { return positions_; }

private:
    pbs::DeltaMushOptions options_;
    std::optional<pbs::BlendSkinning<double>> skinning_;
    std::optional<pbs::DeltaMush> mush_;
    pbs::Positions lbs_, positions_;
};

}  // namespace

DeformerKind delta_mush_kind()
{
    return {.name = "delta_mush",
            .meaning = "LBS, smoothed, to which the detail of the rest shape is added again (Mancewicz 2014): geometry alone",
            .make = [](const DeformerSpec& spec) -> std::unique_ptr<Deformer> {
                return std::make_unique<DeltaMushDeformer>(options_of<pbs::DeltaMushOptions>(spec));
            },
            .options = pbs::DeltaMushOptions{},
            .keys = delta_mush_fields().keys(),
            .read = [](const SceneValues& values, const std::string& table,
                       DeformerSpec& spec) { spec.options = delta_mush_fields().read(values, table); },
            .options_json = [](const DeformerSpec& spec) { return delta_mush_fields().json(options_of<pbs::DeltaMushOptions>(spec)); }};
}

}  // namespace experiments

// LBS and DQS as deformers: no state but the last pose's positions.
#include "experiments/deformers/registry.hpp"
#include "pbs/geometry/stopwatch.hpp"
#include "pbs/skinning/blend_skinning.hpp"

#include <optional>

namespace experiments {
namespace {

class BlendDeformer : public Deformer {
public:
    using Blend = void (pbs::BlendSkinning<double>::*)(const pbs::Pose& pose, pbs::Positions& posed);
    explicit BlendDeformer(Blend blend) : blend_(blend) {}

    void reset(const pbs::Character& character) override
    {
        skinning_.emplace(character.mesh.rest, character.weights);
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
    std::optional<pbs::BlendSkinning<double>> skinning_;
    pbs::Positions positions_;
};

}  // namespace

DeformerKind lbs_kind()
{
    return {.name = "lbs", .meaning = "linear blend skinning, Eq. 1", .make = [](const DeformerSpec&) -> std::unique_ptr<Deformer> {
                return std::make_unique<BlendDeformer>(&pbs::BlendSkinning<double>::linear);
            }};
}

DeformerKind dqs_kind()
{
    return {.name = "dqs",
            .meaning = "dual quaternion skinning (Kavan 2007), the paper's comparison",
            .make = [](const DeformerSpec&) -> std::unique_ptr<Deformer> {
                return std::make_unique<BlendDeformer>(&pbs::BlendSkinning<double>::dual_quaternion);
            }};
}

}  // namespace experiments

// LBS and DQS as deformers: no state but the last pose's positions.
#pragma once

#include "experiments/deformers/registry.hpp"
#include "pbs/skinning/blend_skinning.hpp"

#include <optional>

namespace experiments {

class BlendDeformer : public Deformer {
public:
    using Blend = void (pbs::BlendSkinning<double>::*)(const pbs::Pose& pose, pbs::Positions& posed);
    explicit BlendDeformer(Blend blend) : blend_(blend) {}

    void reset(const pbs::Character& character) override;
    pbs::StepSummary advance(const pbs::Pose& pose, double dt_s) override;
    const pbs::Positions& positions() const override { return positions_; }

private:
    Blend blend_;
    std::optional<pbs::BlendSkinning<double>> skinning_;
    pbs::Positions positions_;
};

DeformerKind lbs_kind();
DeformerKind dqs_kind();

}  // namespace experiments

// LBS, then delta mush.
#pragma once

#include "experiments/deformers/delta_mush/delta_mush.hpp"
#include "experiments/deformers/registry.hpp"
#include "pbs/skinning/blend_skinning.hpp"

#include <optional>

namespace experiments {

class DeltaMushDeformer : public Deformer {
public:
    explicit DeltaMushDeformer(const DeltaMushOptions& options) : options_(options) {}

    void reset(const pbs::Character& character) override;
    pbs::StepSummary advance(const pbs::Pose& pose, double dt_s) override;
    const pbs::Positions& positions() const override { return positions_; }

private:
    DeltaMushOptions options_;
    std::optional<pbs::BlendSkinning<double>> skinning_;
    std::optional<DeltaMush> mush_;
    pbs::Positions lbs_, positions_;
};

DeformerKind delta_mush_kind();

}  // namespace experiments

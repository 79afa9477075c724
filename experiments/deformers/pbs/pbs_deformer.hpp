// The paper's two-layered deformer: LBS, then position based dynamics (Algorithm 1).
#pragma once

#include "experiments/deformers/deformer.hpp"
#include "pbs/skinning/blend_skinning.hpp"
#include "pbs/solver/pbs_solver.hpp"

#include <optional>

namespace experiments {

class PbsDeformer : public Deformer {
public:
    explicit PbsDeformer(const pbs::PbsOptions& options) : options_(options) {}

    void reset(const pbs::Character& character) override;
    pbs::StepSummary advance(const pbs::Pose& pose, double dt_s) override;
    const pbs::Positions& positions() const override { return solver_->positions(); }
    bool has_memory() const override { return options_.jiggle.has_value(); }

private:
    pbs::PbsOptions options_;
    const pbs::Character* character_ = nullptr;
    std::optional<pbs::BlendSkinning<double>> skinning_;
    std::unique_ptr<pbs::PbsSolver> solver_;
    pbs::Positions lbs_;
};

}  // namespace experiments

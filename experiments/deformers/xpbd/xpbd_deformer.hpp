// LBS, then extended position based dynamics with a material.
#pragma once

#include "experiments/deformers/registry.hpp"
#include "experiments/deformers/xpbd/xpbd_solver.hpp"
#include "pbs/skinning/blend_skinning.hpp"

#include <memory>
#include <optional>

namespace experiments {

class XpbdDeformer : public Deformer {
public:
    explicit XpbdDeformer(const XpbdOptions& options) : options_(options) {}

    void reset(const pbs::Character& character) override;
    pbs::StepSummary advance(const pbs::Pose& pose, double dt_s) override;
    const pbs::Positions& positions() const override { return solver_->positions(); }
    bool has_memory() const override { return options_.jiggle; }

private:
    XpbdOptions options_;
    const pbs::Character* character_ = nullptr;
    std::optional<pbs::BlendSkinning<double>> skinning_;
    std::unique_ptr<XpbdSolver> solver_;
    pbs::Positions lbs_;
};

// At equal cost: the iterations of PBS, or as many substeps of one iteration. What jiggles in PBS jiggles here.
DeformerKind xpbd_kind();
DeformerKind xpbd_small_steps_kind();

}  // namespace experiments

// The paper's two-layered deformer: LBS, then position based dynamics (Algorithm 1).
#pragma once

#include "experiments/deformers/registry.hpp"
#include "pbs/skinning/blend_skinning.hpp"
#include "pbs/solver/pbs_solver.hpp"
#include "pbs/solver/poses_solver.hpp"

#include <optional>

namespace experiments {

class PbsDeformer : public Deformer {
public:
    explicit PbsDeformer(const pbs::PbsOptions& options) : options_(options) {}

    void reset(const pbs::Character& character) override;
    pbs::StepSummary advance(const pbs::Pose& pose, double dt_s) override;
    // With more than one thread, on a mesh that one step cannot share among them, frames are projected side by side, sixteen a thread; they
    // get the bits that they would get one by one.
    void foresee(const std::vector<pbs::Pose>& poses) override;
    const pbs::Positions& positions() const override { return ahead_ ? ahead_->positions(done_ahead_ - 1) : solver_->positions(); }
    bool has_memory() const override { return options_.jiggle || options_.lbs_entry == pbs::LbsEntry::increment; }

private:
    bool works_ahead() const;
    pbs::StepSummary advance_ahead(double dt_s);

    pbs::PbsOptions options_;
    const pbs::Character* character_ = nullptr;
    std::optional<pbs::BlendSkinning<double>> skinning_;
    std::unique_ptr<pbs::PbsSolver> solver_;
    pbs::Positions lbs_;

    std::vector<pbs::Pose> foreseen_;            // poses to come; empty: not told, or it does not pay
    std::size_t next_ = 0;                       // of them
    std::unique_ptr<pbs::PosesSolver> ahead_;    // frames next_ - done_ahead_ .. of foreseen_
    std::vector<pbs::StepSummary> steps_ahead_;  // of them
    int done_ahead_ = 0;
};

DeformerKind pbs_kind();

}  // namespace experiments

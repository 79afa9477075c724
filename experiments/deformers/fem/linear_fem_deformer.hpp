// Linear elasticity on the character's own tets, held by its bones, quasi-static: one factor, and one re-solve per frame.
#pragma once

#include "experiments/deformers/deformer.hpp"
#include "experiments/deformers/fem/fem_record.hpp"
#include "reference_fem/linear_elasticity.hpp"

#include <memory>

namespace experiments {

class LinearFemDeformer : public Deformer {
public:
    explicit LinearFemDeformer(const FemOptions& options) : options_(options) {}

    // Assembles and factors. A bone that cannot be gripped is a pbs::InputError that names it.
    void reset(const pbs::Character& character) override;

    // Linear strain is not invariant under rotation, so the pose is taken relative to the root bone: the root's rigid motion is removed
    // before the solve and applied after, which is exact. Gravity is turned into the root's frame.
    pbs::StepSummary advance(const pbs::Pose& pose, double dt_s) override;

    const pbs::Positions& positions() const override { return positions_; }
    std::vector<bool> prescribed() const override;
    nlohmann::json record() const override;

private:
    FemOptions options_;
    const pbs::Character* character_ = nullptr;
    BoneAttachment bones_;
    std::unique_ptr<reference_fem::LinearElasticity> elasticity_;
    FemRecord record_;
    int frames_not_finite_ = 0;
    double largest_residual_ = 0.0;
    int most_iterations_ = 0;   // of an iterative solver, per frame
    pbs::Positions positions_;  // [m], #V x 3
};

}  // namespace experiments

// The judge at large rotations as a deformer: any of the laws on the character's own tets, held by its bones, solved by Newton's method, in
// equilibrium with every pose or in time.
//
// Quasi-static: the way from the last solved pose to the frame's is followed in stages in which no bone turns by more than 45 degrees, each
// halved as often as it takes. Of a frame that is not reached the positions are those of the last equilibrium on the way, the outcome is
// not_converged and the next frame sets out from there; the second in a row is tried again from rest, once. With nested_start a body
// with fewer nodes goes the way to a pose far from the last, and this one sets out from where it arrived; only where that fails it goes the
// way itself. The body with fewer nodes: with order 2 the same one with order 1, of a refined character the unrefined one, each from its
// own such one.
// start_from(): the next frame is Newton's method alone, in the frame's own pose from that shape. Where it does not arrive the positions
// are its last iterate, and the frame after it goes on from there.
//
// In time: the first pose is where the body rests in equilibrium; then every step is a time step. One that does not converge is taken
// back, and the next one covers its time too.
#pragma once

#include "experiments/deformers/deformer.hpp"
#include "experiments/deformers/fem/fem_record.hpp"
#include "experiments/deformers/fem/newton_record.hpp"
#include "experiments/deformers/fem/pose_path.hpp"
#include "experiments/deformers/fem/root_frame.hpp"

#include <memory>

namespace experiments {

class ElasticFemDeformer : public Deformer {
public:
    explicit ElasticFemDeformer(const FemOptions& options) : options_(options) {}

    // A bone that cannot be gripped is a pbs::InputError that names it.
    void reset(const pbs::Character& character) override;

    pbs::StepSummary advance(const pbs::Pose& pose, double dt_s) override;

    const pbs::Positions& positions() const override { return positions_; }
    void start_from(const pbs::Positions& shape) override { start_ = shape; }
    bool has_memory() const override { return options_.dynamics != reference_fem::Dynamics::quasi_static; }
    std::vector<bool> prescribed() const override;
    nlohmann::json record() const override;

private:
    reference_fem::Targets targets_of(const pbs::Pose& pose) const { return targets(bones_, character_->mesh.rest, pose); }
    FrameSolve settle(const RootFrame& frame);  // in the root's frame
    FrameSolve settle_from_start(const RootFrame& frame);
    bool settle_from_fewer_nodes(const pbs::Pose& pose, const RootFrame& frame, FrameSolve& solve);
    pbs::Positions from_fewer_nodes() const;              // [m], #V x 3
    FrameSolve start_at(const RootFrame& frame);          // in the world, at rest
    FrameSolve move(const pbs::Pose& pose, double dt_s);  // in the world
    void follow(const PosePath& way, const Eigen::Isometry3d& place, const pbs::Vec3& gravity_m_s2, FrameSolve& solve);
    void record_grip();

    FemOptions options_;
    const pbs::Character* character_ = nullptr;
    BoneAttachment bones_;
    pbs::Weights guide_weights_;  // empty where the attachment leaves turns free: the start alone would decide on them
    std::unique_ptr<reference_fem::ElasticBody> body_;
    pbs::Pose reached_pose_;   // that the body is in: relative to the root, or in the world where it moves in time
    double unspent_s_ = 0.0;   // time of steps that were taken back
    pbs::Positions start_;     // of the next frame, in the world [m], #V x 3; empty: the last state
    bool is_started_ = false;  // in time: the first pose is there
    int failures_in_a_row_ = 0;
    std::unique_ptr<ElasticFemDeformer> fewer_nodes_;  // nested_start
    FemRecord record_;
    NewtonRecord newton_record_;
    pbs::Positions positions_;  // [m], #V x 3
};

}  // namespace experiments

// The reference at large rotations as a deformer: any of the laws on the character's own tets, held by its bones, solved by Newton's
// method, in equilibrium with every pose or in time.
//
// Quasi-static: the path from the last solved pose to the frame's pose is followed in stages. No bone turns by more than 45 degrees in a
// stage, and each stage is halved until its parts converge. Where a frame is not reached, the positions are those of the last equilibrium
// on the path, the outcome is not_converged, and the next frame begins there; last_state() and the record's worst tet are those in which
// Newton's method ended. The second such frame in a row is tried again from rest, once. nested_start: a body with fewer nodes follows the
// path to a pose far from the last one, and its solution, interpolated by its own elements, is the initial guess of this body, which
// follows the path itself only where that fails. It has order 1 on the same tets if this body has order 2, and otherwise the unrefined
// tets. F is constant in a tet of order 1 and thus the same at all quadrature points of the finer elements, so that an energy which is
// infinite at det F <= 0 is finite in every initial guess. start_from(): the next frame is Newton's method alone, in the frame's own pose,
// from that shape. Where it does not converge, the positions are its last iterate, and the following frame continues from there.
//
// In time: the body rests in equilibrium in the first pose; then every step is a time step. A step that does not converge is undone, and
// the next step covers its time too.
#pragma once

#include "experiments/deformers/deformer.hpp"
#include "experiments/deformers/fem/fem_record.hpp"
#include "experiments/deformers/fem/newton_record.hpp"
#include "pbs/skinning/pose_path.hpp"

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
    FewerNodes set_out_from() const override { return set_out_from_; }
    std::optional<double> lowest_det_f() const override { return lowest_det_f_; }
    pbs::Positions last_state() const override { return last_state_; }
    nlohmann::json record() const override;

private:
    reference_fem::Targets targets_of(const pbs::Pose& pose) const { return targets(bones_, character_->mesh.rest, pose); }
    FrameSolve settle(const pbs::RootFrame& frame);  // in the root's frame
    FrameSolve settle_from_start(const pbs::RootFrame& frame);
    bool settle_from_fewer_nodes(const pbs::Pose& pose, const pbs::RootFrame& frame, FrameSolve& solve);
    bool may_go_the_way(const FrameSolve& solve) const;
    FrameSolve start_at(const pbs::RootFrame& frame);     // in the world, at rest
    FrameSolve move(const pbs::Pose& pose, double dt_s);  // in the world
    void follow(const pbs::PosePath& way, const Eigen::Isometry3d& place, const pbs::Vec3& gravity_m_s2, FrameSolve& solve);
    pbs::Positions last_iterate_at(const pbs::Positions& points_at_rest) const;
    void record_solve(const FrameSolve& solve);
    void record_grip();

    FemOptions options_;
    const pbs::Character* character_ = nullptr;
    BoneAttachment bones_;
    pbs::Weights guide_weights_;  // empty where the attachment leaves rotations free: the initial guess alone would determine them
    std::unique_ptr<reference_fem::ElasticBody> body_;
    pbs::Pose reached_pose_;   // of the body: relative to the root, or in the world where it moves in time
    double unspent_s_ = 0.0;   // time of the steps that were undone
    pbs::Positions start_;     // initial guess of the next frame, in the world [m], #V x 3; empty: the last state
    bool is_started_ = false;  // a pose has been solved
    int failures_in_a_row_ = 0;
    std::unique_ptr<ElasticFemDeformer> fewer_nodes_;  // nested_start
    FewerNodes set_out_from_;
    bool has_tried_ = true;  // to reach the last pose by Newton's method; if not, the solution with fewer nodes was not reached
    std::optional<double> lowest_det_f_;
    FemRecord record_;
    NewtonRecord newton_record_;
    pbs::Positions positions_, last_state_;  // [m], #V x 3
};

}  // namespace experiments

// The finite element reference as deformers, linear and at large rotations, and their records, which accumulate over
// the frames.
#pragma once

#include "experiments/deformers/deformer.hpp"
#include "experiments/deformers/fem/bone_attachment.hpp"
#include "pbs/skinning/pose.hpp"
#include "reference_fem/elastic_body.hpp"
#include "reference_fem/linear_elasticity.hpp"

#include <nlohmann/json.hpp>

#include <memory>

namespace experiments {

// The options of the linear solver.
reference_fem::LinearOptions linear_options(const FemOptions& options);

// The kind of the attachment and those parameters that it has.
nlohmann::json attachment_json(const FemOptions& options);

// The solves for one frame.
struct FrameSolve {
    std::vector<reference_fem::LoadPathSummary> stages;  // in their order; after a restart those of both attempts
    double reached = 0.0;                                // fraction of the last path, 1: the frame's own pose
    bool restarted = false;                              // from rest

    bool converged() const { return reached >= 1.0; }
};

// The cost of Newton's method for a nonlinear reference, the guards that were needed, and each frame that was not
// reached, with the reason.
class NewtonRecord {
public:
    NewtonRecord() = default;
    explicit NewtonRecord(double rest_volume_m3) : rest_volume_m3_(rest_volume_m3) {}

    // flesh: at the end of the frame, or in the last state of Newton's method if the frame is not reached
    void add_frame(const FrameSolve& solve, const reference_fem::Jacobians& flesh);
    // Adds a frame in which Newton's method was not tried, since the solution with fewer nodes was not reached.
    void add_frame_without_start(const nlohmann::json& failure_with_fewer_nodes);

    const nlohmann::json& last_failure() const { return not_converged_.back(); }  // there must be one
    nlohmann::json to_json() const;

private:
    int frames_ = 0, restarts_ = 0;
    int newton_steps_ = 0, most_newton_steps_ = 0;  // in total, and the most of one frame
    int factorisations_ = 0, projected_ = 0, halvings_ = 0;
    double seconds_ = 0.0, longest_s_ = 0.0;
    nlohmann::json not_converged_ = nlohmann::json::array();

    // Over the frames that converged, at the elements' own quadrature points.
    double rest_volume_m3_ = 0.0, smallest_volume_change_ = 0.0, largest_volume_change_ = 0.0;
    double lowest_det_f_ = 1.0;
    int most_inverted_points_ = 0;
};

// What both deformers have, with the record of what the attachment grips of each bone and how well, of the set-up, and
// of the largest rotation.
class FemDeformer : public Deformer {
public:
    const pbs::Positions& positions() const override { return positions_; }
    const FemFacts* facts() const override { return &facts_; }

protected:
    explicit FemDeformer(const FemOptions& options) : options_(options) {}

    // At rest, with character_ and bones_. spring_tet: the tet that holds each spring, -1: outside. A bone that grips
    // nothing is recorded with tets_gripped = 0. prescribed_vertices: with nodes.
    void start(const std::vector<int>& spring_tet, const std::vector<bool>& prescribed_vertices);
    reference_fem::Targets targets_of(const pbs::Pose& pose) const
    {
        return targets(bones_, character_->mesh.rest, pose);
    }

    void record_frame(const pbs::Pose& relative_pose);  // relative to the root
    // targets [m], #holds x 3: where the holds (springs, or bind points) should be. errors_m, #holds: the distance of
    // the flesh from them; not a number for a hold outside the flesh.
    void record_grip(const pbs::Positions& targets, const Eigen::VectorXd& errors_m);
    nlohmann::json recorded(const reference_fem::SetupSummary& setup) const;

    FemOptions options_;
    const pbs::Character* character_ = nullptr;
    BoneAttachment bones_;
    FemFacts facts_;
    pbs::Positions positions_;  // [m], #V x 3

private:
    nlohmann::json grips_;             // the flesh that the attachment of each bone holds, #bones
    std::vector<int> hold_bone_;       // #holds
    pbs::Positions hold_rest_;         // [m], #holds x 3
    std::vector<double> hold_weight_;  // #holds: the relative density of springs; 1 with bind
    // #bones: largest over the frames of the frame's rms error of its holds, weighted by their density
    std::vector<double> grip_error_m_;
    int frames_ = 0;
    double largest_rotation_rad_ = 0.0, largest_grip_error_m_ = 0.0;
    double grip_error_over_motion_ = 0.0;  // largest over the frames of rms error / rms motion of all holds
};

// Linear elasticity on the character's own tets, held by its bones, quasi-static: one factor, and one re-solve per
// frame. Linear strain is not invariant under rotation, so the pose is taken relative to the root bone: the root's
// rigid motion is removed before the solve and applied after, which is exact. Gravity is turned into the root's frame.
class LinearFemDeformer : public FemDeformer {
public:
    explicit LinearFemDeformer(const FemOptions& options) : FemDeformer(options) {}

    void reset(const pbs::Character& character) override;  // assembles and factors
    pbs::StepSummary advance(const pbs::Pose& pose, double dt_s) override;
    nlohmann::json record() const override;

private:
    std::unique_ptr<reference_fem::LinearElasticity> elasticity_;
    int frames_not_finite_ = 0;
    double largest_residual_ = 0.0;
};

// The reference at large rotations: any of the laws on the character's own tets, held by its bones, solved by Newton's
// method, in equilibrium with every pose or in time.
//
// Quasi-static: the path from the last solved pose to the frame's pose is followed in stages. No bone turns by more
// than 45 degrees in a stage, and each stage is halved until its parts converge. Where a frame is not reached, the
// positions are those of the last equilibrium on the path, the outcome is not_converged, and the next frame begins
// there; FemFacts::last_state and the record's worst tet are those in which Newton's method ended. The second such
// frame in a row is tried again from rest, once. nested_start: a body with fewer nodes follows the path to a pose far
// from the last one, and its solution, interpolated by its own elements, is the initial guess of this body, which
// follows the path itself only where that fails. It has order 1 on the same tets if this body has order 2, and
// otherwise the unrefined tets. F is constant in a tet of order 1 and thus the same at all quadrature points of the
// finer elements, so that an energy which is infinite at det F <= 0 is finite in every initial guess. start_from(): the
// next frame is Newton's method alone, in the frame's own pose, from that shape. Where it does not converge, the
// positions are its last iterate, and the following frame continues from there. With contact, a shape that intersects
// itself is refused (intersects_itself), and the body goes back to rest.
//
// In time: the body rests in equilibrium in the first pose; then every step is a time step. A step that does not
// converge is undone, and the next step covers its time too.
class ElasticFemDeformer : public FemDeformer {
public:
    explicit ElasticFemDeformer(const FemOptions& options) : FemDeformer(options) {}

    void reset(const pbs::Character& character) override;
    pbs::StepSummary advance(const pbs::Pose& pose, double dt_s) override;
    void start_from(const pbs::Positions& shape) override { start_ = shape; }
    void continue_from(const pbs::Pose& pose, const pbs::Positions& positions) override;
    void give_up_when(std::function<bool()> is_over) override;
    bool has_memory() const override { return options_.dynamics != reference_fem::Dynamics::quasi_static; }
    nlohmann::json record() const override;

private:
    FrameSolve settle(const pbs::RootFrame& frame);  // in the root's frame
    FrameSolve settle_from_start(const pbs::RootFrame& frame);
    bool settle_from_fewer_nodes(const pbs::Pose& pose, const pbs::RootFrame& frame, FrameSolve& solve);
    bool may_go_the_way(const FrameSolve& solve) const;
    FrameSolve start_at(const pbs::RootFrame& frame);     // in the world, at rest
    FrameSolve move(const pbs::Pose& pose, double dt_s);  // in the world
    void follow(const pbs::PosePath& way, const Eigen::Isometry3d& place, const pbs::Vec3& gravity_m_s2,
                FrameSolve& solve);
    pbs::Positions last_iterate_at(const pbs::Positions& points_at_rest) const;
    pbs::Positions in_the_world(const pbs::Positions& points) const;
    void find_tips();
    void record_solve(const FrameSolve& solve);

    pbs::Weights guide_weights_;  // empty where the attachment leaves rotations free: the initial guess alone would
                                  // determine them
    std::unique_ptr<reference_fem::ElasticBody> body_;
    std::vector<double> limb_radius_m_;    // of each bone
    std::optional<pbs::RootFrame> frame_;  // of the last pose
    pbs::Pose reached_pose_;               // of the body: relative to the root, or in the world where it moves in time
    double unspent_s_ = 0.0;               // time of the steps that were undone
    pbs::Positions start_;     // initial guess of the next frame, in the world [m], #V x 3; empty: the last state
    bool is_started_ = false;  // a pose has been solved
    int failures_in_a_row_ = 0;
    std::unique_ptr<ElasticFemDeformer> fewer_nodes_;  // nested_start
    bool has_tried_ =
        true;  // to reach the last pose by Newton's method; if not, the solution with fewer nodes was not reached
    NewtonRecord newton_record_;
    int frames_in_contact_ = 0, most_contact_pairs_ = 0;
    double smallest_gap_m_ = 0.0;  // of these pairs
};

}  // namespace experiments

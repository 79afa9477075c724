// The record of Newton's method for a nonlinear reference: its cost, the guards that were needed, and each frame that was not reached, with
// the reason. It accumulates over the frames.
#pragma once

#include "reference_fem/elastic_body.hpp"

#include <nlohmann/json.hpp>

namespace experiments {

// The solves for one frame.
struct FrameSolve {
    std::vector<reference_fem::LoadPathSummary> stages;  // in their order; after a restart those of both attempts
    double reached = 0.0;                                // fraction of the last path, 1: the frame's own pose
    bool restarted = false;                              // from rest

    bool converged() const { return reached >= 1.0; }
};

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
    void add_stage(const reference_fem::LoadPathSummary& stage);
    void add_failure(const FrameSolve& solve, const reference_fem::Jacobians& flesh);

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

}  // namespace experiments

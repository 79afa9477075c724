// The record of a reference's frames, for every model: what the attachment grips of each bone and how well, the set-up, and the largest
// rotation. It accumulates over the frames.
#pragma once

#include "experiments/deformers/fem/bone_attachment.hpp"

#include <nlohmann/json_fwd.hpp>

namespace experiments {

// The flesh that the attachment of one bone holds.
struct BoneGrip {
    std::string name;
    int holds = 0;             // smooth and embedded: sample points; bind: vertices
    int inside = 0;            // the holds that are in the flesh
    int tets = 0;              // tets gripped
    double skin_share = 0.0;   // share of the gripped tets' vertices that lie on the skin
    int shared_vertices = 0;   // vertices of the gripped tets that another bone grips too: P1 cannot follow both
    double error_rms_m = 0.0;  // largest over the frames of the frame's rms error of its holds, weighted by their density
};

// The kind of the attachment and those parameters that it has.
nlohmann::json attachment_json(const FemOptions& options);

class FemRecord {
public:
    FemRecord() = default;

    // spring_tet: the tet that holds each spring, -1: outside. A bone that grips nothing is a pbs::InputError, except with bind.
    FemRecord(const pbs::Character& character, const FemOptions& options, const BoneAttachment& bones, const std::vector<int>& spring_tet);

    void add_frame(const pbs::Pose& relative_pose);  // relative to the root
    // targets [m], #holds x 3: where the holds (springs, or bind points) should be. errors_m, #holds: the distance of the flesh from them;
    // not a number for a hold outside the flesh.
    void add_grip(const pbs::Positions& targets, const Eigen::VectorXd& errors_m);

    nlohmann::json to_json(const reference_fem::SetupSummary& setup) const;

private:
    void add_bound_vertices(const pbs::Character& character);
    void add_gripped_tets(const pbs::Character& character, const std::vector<int>& spring_tet);
    nlohmann::json attachment_and_grips() const;

    FemOptions options_;
    BoneAttachment bones_;
    std::vector<int> hold_bone_;       // #holds
    pbs::Positions hold_rest_;         // [m], #holds x 3
    std::vector<double> hold_weight_;  // #holds: the relative density of springs; 1 with bind
    std::vector<BoneGrip> grips_;      // #bones
    int frames_ = 0;
    double largest_rotation_rad_ = 0.0;
    double largest_grip_error_m_ = 0.0;
    double grip_error_over_motion_ = 0.0;  // largest over the frames of rms error / rms motion of all holds
};

}  // namespace experiments

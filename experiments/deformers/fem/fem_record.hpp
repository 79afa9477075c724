// What goes on record beside a reference's frames: what was gripped of each bone and how well, set-up, residuals, and how far linear
// strain was taken beyond what it is good for. Accumulated over the frames so far.
#pragma once

#include "experiments/deformers/fem/bone_attachment.hpp"

#include <nlohmann/json.hpp>

namespace experiments {

// What the attachment takes hold of for one bone.
struct BoneGrip {
    std::string name;
    int samples = 0;  // embedded: sample points, and how many lie in the flesh
    int inside = 0;
    int tets = 0;              // tets gripped
    double skin_share = 0.0;   // share of the gripped tets' vertices that lie on the skin
    int shared_vertices = 0;   // of the gripped tets' vertices, those that another bone grips too: P1 cannot follow both
    double error_rms_m = 0.0;  // embedded: largest over the frames of the frame's rms |target - where it went|
};

class FemRecord {
public:
    FemRecord() = default;

    // spring_tet: the tet that holds each spring, -1: outside. A bone that grips nothing is a pbs::InputError.
    FemRecord(const pbs::Character& character, const FemOptions& options, const BoneAttachment& bones, const std::vector<int>& spring_tet);

    // Targets and where the springs' points went [m], #springs x 3; poses relative to the root.
    void add_frame(const pbs::Pose& relative_pose, const pbs::Positions& targets, const pbs::Positions& deformed,
                   const reference_fem::SolveSummary& solve);

    nlohmann::json to_json(const reference_fem::SetupSummary& setup) const;

private:
    void add_grip_errors(const pbs::Positions& targets, const pbs::Positions& deformed);

    FemOptions options_;
    BoneAttachment bones_;
    std::vector<BoneGrip> grips_;  // #bones
    int frames_ = 0, frames_not_finite_ = 0;
    double largest_rotation_rad_ = 0.0;  // of a bone relative to the root
    double largest_residual_ = 0.0;
    double largest_grip_error_m_ = 0.0;
    double grip_error_over_motion_ = 0.0;  // largest over the frames of rms error / rms motion of all spring points
};

}  // namespace experiments

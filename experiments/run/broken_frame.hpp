// A frame that broke down, with its worst element. run.json lists such frames under outcome.broken_frames, by the deformer's label.
//   broken[label].push_back(broken_frame(frame, step.outcome, positions, measurer.volume_ratios(positions)));
//   text_of(broken[label].back())   "inverted in frame 7: worst tet 812 of volume ratio -0.04, 3 inverted"
#pragma once

#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/solver/step_summary.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace experiments {

struct BrokenFrame {
    int frame = 0;
    std::string what;  // not_finite, not_converged, inverted
    int step = -1;     // of the motion, if it broke down in a step before that of the frame; the elements are always those of the frame
    // The elements of a frame that is not converged are those of the solver's last state (Deformer::last_state).
    // If positions are not finite: the first such vertex and the number of them. Otherwise -1, 0.
    int vertex = -1, vertices = 0;
    // If they are finite: the tet of the lowest volume ratio J_t = V_t / V0_t, and the number of tets with J_t <= 0. Otherwise -1, 0, 0.
    int tet = -1;
    double volume_ratio = 0.0;
    int inverted_tets = 0;
};

// positions [m], #V x 3; volume_ratios: J_t, #T. A frame whose outcome is finished broke down because it inverted tets.
BrokenFrame broken_frame(int frame, pbs::Outcome outcome, const pbs::Positions& positions, const Eigen::VectorXd& volume_ratios);

std::string worst_element(const BrokenFrame& broken);  // "first at vertex 17, 120 not finite"
std::string what_of(const BrokenFrame& broken);        // in words: "not finite"
std::string text_of(const BrokenFrame& broken);

void to_json(nlohmann::json& json, const BrokenFrame& broken);
void from_json(const nlohmann::json& json, BrokenFrame& broken);

}  // namespace experiments

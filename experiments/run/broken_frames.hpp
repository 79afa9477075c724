// The frames of a run that broke down, each with its worst element. run.json lists them under `outcome`.
//   BrokenFrames broken;
//   broken.add("pbs", broken_frame(frame, step.outcome, positions, measurer.volume_ratios(positions)), false);
//   broken.breakdown()   "pbs is not finite in frame 7: first at vertex 17, 120 not finite"
#pragma once

#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/solver/step_summary.hpp"

#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>

#include <map>
#include <string>
#include <vector>

namespace experiments {

struct BrokenFrame {
    int frame = 0;
    std::string what;  // not_finite, not_converged, inverted
    int step = -1;  // of the motion, if it broke down in a step before that of the frame; the elements are always those
                    // of the frame
    // The elements of a frame that is not converged are those of the solver's last state (Deformer::last_state).
    // If positions are not finite: the first such vertex and the number of them. Otherwise -1, 0.
    int vertex = -1, vertices = 0;
    // If they are finite: the tet of the lowest volume ratio J_t = V_t / V0_t, and the number of tets with J_t <= 0.
    // Otherwise -1, 0, 0.
    int tet = -1;
    double volume_ratio = 0.0;
    int inverted_tets = 0;
};

// positions [m], #V x 3; volume_ratios: J_t, #T. A frame whose outcome is finished broke down because it inverted tets.
BrokenFrame broken_frame(int frame, pbs::Outcome outcome, const pbs::Positions& positions,
                         const Eigen::VectorXd& volume_ratios);

std::string worst_element(const BrokenFrame& broken);  // "first at vertex 17, 120 not finite"
std::string what_of(const BrokenFrame& broken);        // in words: "not finite"
std::string text_of(const BrokenFrame& broken);

void to_json(nlohmann::json& json, const BrokenFrame& broken);
void from_json(const nlohmann::json& json, BrokenFrame& broken);

class BrokenFrames {
public:
    // In the order in which they occur. is_expected: of a negative control, whose breakdowns are only recorded.
    void add(const std::string& label, const BrokenFrame& frame, bool is_expected)
    {
        entries_.push_back({label, frame, is_expected});
    }

    // The first unexpected frame that was not finite; empty: there is none.
    std::string breakdown() const;
    // The first unexpected frame that was not reached or has inverted tets, and how many of the run's frames broke
    // down; empty: none.
    std::string bad_frame(int frames) const;
    // The frames with this outcome by the deformer's label.
    std::map<std::string, std::vector<int>> frames_with(pbs::Outcome outcome) const;
    // Members of run.json's outcome: breakdown, bad_frame, breakdowns, not_converged, broken_frames.
    nlohmann::json record(int frames) const;

private:
    struct Entry {
        std::string label;
        BrokenFrame frame;
        bool is_expected = false;
    };
    const Entry* first_unexpected(bool is_finite) const;

    std::vector<Entry> entries_;
};

}  // namespace experiments

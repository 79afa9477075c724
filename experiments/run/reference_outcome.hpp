// What a reference with a budget of processor time (spread_reference.hpp) has reached: its record in run.json, and the
// remarks for the user.
//   json["reference"] = outcome;
//   for (const pbs::Remark& remark : remarks_on(outcome, scene.file)) ...
#pragma once

#include "experiments/characters/remark.hpp"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <vector>

namespace experiments {

// A frame that the solver tried and did not reach.
struct FrameNotReached {
    int frame = 0;
    double seconds = 0.0;  // of processor time that the attempt took
    std::string bone;      // whose flesh is most compressed in the state in which the solver ended; empty: unknown
};

struct ReferenceOutcome {
    int frames = 0;                                    // of the motion
    int solved = 0;                                    // frames with a solution
    int kept = 0;                                      // solved frames that an earlier run had solved
    std::vector<FrameNotReached> not_reached = {};     // although they were tried
    double seconds = 0.0;                              // of processor time that were spent
    std::optional<FrameNotReached> with_contact = {};  // the frame for which contact was given up
    bool was_interrupted = false;

    // At most one frame was reached, and so many were not that the others are not tried.
    bool is_hopeless() const;
};

// Says where contact is missing, and which frames were not reached or left out. scene_file begins each remark.
pbs::RemarkList remarks_on(const ReferenceOutcome& outcome, const std::string& scene_file);
void to_json(nlohmann::json& json, const FrameNotReached& frame);
void to_json(nlohmann::json& json, const ReferenceOutcome& outcome);

}  // namespace experiments

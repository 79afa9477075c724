// How far the jiggling flesh lags behind the skeleton through a motion, and whether it comes to rest when the motion does.
//   const WalkResponse response = walk_response(character, motion, spec, zone);
#pragma once

#include "experiments/deformers/registry.hpp"

#include <vector>

namespace experiments {

struct WalkResponse {
    std::vector<double> lag_rms_m;      // over the zone, from the shape without jiggle in the same pose; one per step, the still ones last
    std::vector<double> speed_rms_m_s;  // of the zone's vertices
    double moving_lag_mm = 0.0, most_lag_mm = 0.0;  // root mean square and largest over the motion
    double last_speed_share = 0.0;                  // of the last tenth of the still steps, over the motion's mean
    bool finished = true;
};

// The last pose is held for `still_steps` more steps. The same deformer without jiggle runs for comparison.
WalkResponse walk_response(const pbs::Character& character, const pbs::Motion& motion, const DeformerSpec& spec,
                           const std::vector<bool>& zone, int still_steps);

}  // namespace experiments

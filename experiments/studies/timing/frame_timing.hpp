// What a frame of a character costs on one core, in its parts, by turns: LBS, the three classes of constraints over 24 iterations, the
// whole frame as a deformer does it, and the same with the embedded surface that is drawn.
//   const std::vector<FrameTiming> timings = time_frames(character, motion, {.k_jiggle = 0.9}, {.seconds = 2.0});
// Every turn goes on in the motion by a few frames. Wall time of whole frames, which is what a frame rate is of; processor time of the
// thread of parts, and of whole frames beside. A class is timed over its 24 iterations at once, without the others between, so that a
// clock is read twice a class; what its values are does not change its work, but small meshes stay in cache, so parts need not add up.
#pragma once

#include "experiments/studies/shared/timed_rounds.hpp"
#include "pbs/character/character.hpp"
#include "pbs/solver/options.hpp"

#include <string>
#include <vector>

namespace experiments {

inline constexpr int timed_iterations = 24;

struct TimedFrames {
    double k_jiggle = 0.9;  // of stretch constraints in the jiggling zone, as Table 1 has them
    int frames_a_turn = 2;
};

struct FrameTiming {
    std::string variant = {}, precision = {};  // plain, ordered; f32, f64
    Spread lbs_ms = {}, bind_ms = {}, stretch_ms = {}, volume_ms = {};
    Spread rest_ms = {};                       // a step of no iterations: bind points, prediction, copying in and out, velocities
    Spread total_ms = {}, total_wall_ms = {};  // with LBS
    Spread surface_ms = {};                    // of the embedded surface, not in total; no rounds where there is none
    Spread drawn_wall_ms = {};                 // total_wall and the surface; no rounds where there is none

    double frames_per_s() const { return 1e3 / total_wall_ms.median; }
};

// plain f64, plain f32, ordered f32.
std::vector<FrameTiming> time_frames(const pbs::Character& character, const pbs::Motion& motion, const TimedFrames& timed,
                                     const Rounds& rounds);

}  // namespace experiments

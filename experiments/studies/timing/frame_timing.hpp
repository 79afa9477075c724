// The cost of a frame of a character on one core, and its parts: LBS, the three classes of constraints over 24 iterations, the whole frame
// as a deformer computes it, and the same with the embedded surface. The variants take turns.
//   const std::vector<FrameTiming> timings = time_frames(character, motion, {.k_jiggle = 0.9}, {.seconds = 2.0});
// Every turn continues in the motion by a few frames. Whole frames are measured in wall time, from which a frame rate follows, and in
// processor time of the thread; parts are measured in processor time. A class is timed over its 24 iterations without the other classes in
// between, so that the clock is read twice per class. Its work does not depend on its values, but small meshes stay in the cache, so the
// parts need not add up.
#pragma once

#include "experiments/studies/shared/timed_rounds.hpp"
#include "pbs/character/character.hpp"
#include "pbs/solver/options.hpp"

#include <optional>
#include <string>
#include <vector>

namespace experiments {

inline constexpr int timed_iterations = 24;

struct TimedFrames {
    double k_jiggle = 0.9;  // stiffness of the stretch constraints in the jiggling zone, as in Table 1
    int frames_per_turn = 2;
};

struct FrameTiming {
    std::string variant = {}, precision = {};  // plain, ordered; f32, f64
    Spread lbs_ms = {}, bind_ms = {}, stretch_ms = {}, volume_ms = {};
    Spread rest_ms = {};                       // a step without iterations: bind points, prediction, copies in and out, velocities
    Spread total_ms = {}, total_wall_ms = {};  // with LBS
    std::optional<Spread> surface_ms = {};     // the embedded surface, which is not part of the total; empty without a surface
    std::optional<Spread> drawn_wall_ms = {};  // total_wall_ms and the surface; empty without a surface
};

// plain f64, plain f32, ordered f32.
std::vector<FrameTiming> time_frames(const pbs::Character& character, const pbs::Motion& motion, const TimedFrames& timed,
                                     const Rounds& rounds);

}  // namespace experiments

// The stretch of a recorded motion that is taken, and the frames and time steps that are made of it.
#pragma once

#include <string>

namespace pbs {

struct MotionSampling {
    double start_s = 0.0;
    double duration_s = 0.0;    // 0: to the end
    double rate_hz = 100.0;     // frames per second of the motion that is made, whatever the recorded rate
    double time_step_s = 0.01;  // of Algorithm 1; rate_hz * time_step_s = 1 / n: n steps per frame
};

// n. InputErrors: a rate or a time step that is not positive; a product of the two that is not 1 / n with n from 1 to 100,000.
int steps_per_frame(const MotionSampling& sampling);

// The number of frames after the first one in a recording that lasts length_s. The stretch may reach beyond the recording by slack_s, for
// rounding. An InputError names `file`.
int frames_after_the_first(const MotionSampling& sampling, double length_s, double slack_s, const std::string& file);

// The longest time step [s] of at most longest_s that divides a frame into whole steps.
double time_step_for(double rate_hz, double longest_s = 0.01);

}  // namespace pbs

#include "pbs/skinning/pose_path.hpp"

#include "pbs/geometry/input_error.hpp"

#include <algorithm>
#include <cmath>

namespace pbs {
namespace {

constexpr double most_steps_per_frame = 1e5;
constexpr double rounding = 1e-6;  // of a step or frame: times given in decimal are not refused for their last digit

}  // namespace

int steps_per_frame(const MotionSampling& sampling)
{
    if (!(sampling.rate_hz > 0.0)) throw InputError("", 0, "rate_hz", std::to_string(sampling.rate_hz), "expected a rate > 0");
    if (!(sampling.time_step_s > 0.0)) throw InputError("", 0, "time_step_s", std::to_string(sampling.time_step_s), "expected a time > 0");
    const double steps = 1.0 / (sampling.rate_hz * sampling.time_step_s);
    if (!(std::round(steps) >= 1.0 && std::abs(steps - std::round(steps)) <= rounding * steps))
        throw InputError("", 0, "rate_hz * time_step_s", std::to_string(1.0 / steps), "expected 1 / n: n steps per frame");
    if (steps > most_steps_per_frame)
        throw InputError("", 0, "rate_hz * time_step_s", std::to_string(1.0 / steps), "expected at most 100000 steps per frame");
    return static_cast<int>(std::round(steps));
}

int frames_after_the_first(const MotionSampling& sampling, double length_s, double slack_s, const std::string& file)
{
    if (!(sampling.start_s >= 0.0 && sampling.start_s <= length_s + slack_s))
        throw InputError(file, 0, "start_s", std::to_string(sampling.start_s), "the clip lasts " + std::to_string(length_s) + " s");
    if (!(sampling.duration_s >= 0.0 && sampling.start_s + sampling.duration_s <= length_s + slack_s))
        throw InputError(file, 0, "duration_s", std::to_string(sampling.duration_s),
                         "the clip ends at " + std::to_string(length_s) + " s, " + std::to_string(length_s - sampling.start_s) + " s on");
    const double duration_s = sampling.duration_s > 0.0 ? sampling.duration_s : length_s - sampling.start_s;
    return static_cast<int>(std::floor(duration_s * sampling.rate_hz + rounding));
}

double time_step_for(double rate_hz, double longest_s)
{
    return 1.0 / (rate_hz * std::max(1.0, std::ceil(1.0 / (rate_hz * longest_s) - rounding)));
}

}  // namespace pbs

// Bounds on single frames, and their results frame by frame and as test cases. Each bound has the name of the option that sets it.
#pragma once

#include "analysis/check/check_case.hpp"
#include "analysis/frame_metrics.hpp"

#include <optional>
#include <string>
#include <vector>

namespace analysis {

struct FrameValues {
    FrameMetrics metrics;
    double j_max = 0.0;            // largest V_t / V0_t
    double edge_strain_max = 0.0;  // largest |l / l0 - 1|
};

struct FrameBound {
    std::string option;  // --max-volume-change
    std::string metric;  // |volume_change_pct|
    std::string meaning;
    bool is_upper = true;
    double lowest = 0.0;  // the lowest bound that makes sense
    double (*of)(const FrameValues&) = nullptr;
    std::optional<double> value = {};  // nothing: the bound is not asked for
};
std::vector<FrameBound> known_frame_bounds();

// InputError for a bound that no frame or every frame meets: not finite, or below the lowest possible value.
void require_meaningful(const FrameBound& bound);

// A bound that does not hold, e.g. "|volume_change_pct| = 0.62 > 0.5". Empty if it holds or was not asked for. A value that is not a
// number breaks every bound.
std::string broken_text(const FrameBound& bound, const FrameValues& values);

struct MeasuredFrame {
    std::string name;
    FrameValues values;
};

struct RefusedFrame {
    std::string name, reason;
};

// One case per bound, which names the worst frame and counts the others, or a case "measured" if no bound was asked for. One case per
// refused frame.
CheckSuite frame_suite(const std::string& name, const std::vector<FrameBound>& bounds, const std::vector<MeasuredFrame>& frames,
                       const std::vector<RefusedFrame>& refused, double seconds);

}  // namespace analysis

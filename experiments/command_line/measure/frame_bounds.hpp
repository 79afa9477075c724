// Bounds on foreign frames, given on the command line; what became of them, frame by frame and as test cases.
#pragma once

#include "analysis/check/check_case.hpp"
#include "analysis/frame_metrics.hpp"

#include <optional>
#include <string>
#include <vector>

namespace experiments {

struct FrameFigures {
    analysis::FrameMetrics metrics;
    double j_max = 0.0;            // largest V_t / V0_t
    double edge_strain_max = 0.0;  // largest |l / l0 - 1|
};

struct FrameBound {
    std::string option;  // --max-volume-change
    std::string figure;  // |volume_change_pct|
    std::string meaning;
    bool is_upper = true;
    double lowest = 0.0;  // that makes sense as a value
    double (*of)(const FrameFigures&) = nullptr;
    std::optional<double> value = {};  // not given: not asked
};
std::vector<FrameBound> known_frame_bounds();

// InputError for a value that nothing or everything meets: not finite, or below the least that the figure can be.
void require_meaningful(const FrameBound& bound);

// A bound that does not hold, e.g. "|volume_change_pct| = 0.62 > 0.5"; empty where it holds or was not asked. What is not a number breaks
// every bound.
std::string broken_text(const FrameBound& bound, const FrameFigures& figures);

struct MeasuredFrame {
    std::string name;
    FrameFigures figures;
};

struct RefusedFrame {
    std::string name, reason;
};

// One case a bound, which names the worst frame and counts the others; a case "measured" where no bound was asked; one a refused frame.
analysis::CheckSuite frame_suite(const std::string& name, const std::vector<FrameBound>& bounds, const std::vector<MeasuredFrame>& frames,
                                 const std::vector<RefusedFrame>& refused, double seconds);

}  // namespace experiments

// The rules of a check: scenes, bounds on their frames, and tolerances for the comparison with a baseline. They are data in TOML; the keys
// are documented at [[check.scene]] in experiments/verdicts/claims.toml.
//   const CheckRules rules = parse_check_rules(text, "check.toml", known_metrics);
#pragma once

#include "analysis/check/check_report.hpp"
#include "analysis/metrics/frame_metrics.hpp"

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace analysis {

// One table [[check.scene]].
struct CheckScene {
    std::string name;              // the name by which bounds refer to it
    std::string scene;             // a built-in scene, or a file in the same folder
    std::vector<std::string> set;  // key=value, as for `pbskin run --set`
    std::string needs;             // a body; the scene is left out where that body is not installed
    int line = 0;                  // line of its table, from 1
};

// One table [[check.bound]]: low <= metric <= high in each of its frames.
struct CheckBound {
    std::string name, scene, deformer, metric;  // scene: a CheckScene's name; metric: a column of metrics.csv
    double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();  // in the metric's unit
    std::vector<int> frames;                                                                                // first and last; empty: all
    std::string why;  // the reason for the bound, in words
    int line = 0;     // line of its table, from 1
};

// A value counts as unchanged when |now - then| <= absolute + relative |then|.
struct CheckTolerance {
    std::string metric;                     // a column of metrics.csv
    double absolute = 0.0, relative = 0.0;  // in the metric's unit; as a share. Both are finite and >= 0
    std::string why;                        // the reason for the tolerance, in words
    int line = 0;                           // line of its table, from 1; 0: a count, which is compared exactly
};

// The rules of one file, read and checked.
struct CheckRules {
    std::string file;                        // for messages
    std::vector<CheckScene> scenes;          // at least one, each name once
    std::vector<CheckBound> bounds;          // each name once; may be empty
    std::vector<CheckTolerance> tolerances;  // at most one per metric
};

// InputError with file and line for broken TOML, unknown or missing keys, metrics that are not among `metrics` or are wall time, bounds on
// scenes that are not named, duplicate names, and bounds that no value can meet.
CheckRules parse_check_rules(const std::string& text, const std::string& file, const std::vector<std::string>& metrics);

// Bounds on single frames, and their results frame by frame and as test cases. Each bound has the name of the option that sets it.
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

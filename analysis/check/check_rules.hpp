// The rules of a check: scenes, bounds on their frames, and tolerances for the comparison with a baseline. They are data in TOML; the keys
// are documented at [[check.scene]] in experiments/verdicts/claims.toml.
//   const CheckRules rules = parse_check_rules(text, "check.toml", known_metrics);
#pragma once

#include <limits>
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

}  // namespace analysis

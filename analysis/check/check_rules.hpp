// What a check measures and holds: scenes, bounds on their frames, tolerances of the comparison with a baseline. As data in TOML; the keys
// are documented at [[check.scene]] in experiments/verdicts/claims.toml.
//   const CheckRules rules = parse_check_rules(text, "check.toml", known_metrics);
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace analysis {

// A [[check.scene]].
struct CheckScene {
    std::string name;              // what bounds call it
    std::string scene;             // built in, or a file beside this one
    std::vector<std::string> set;  // key=value, as of `pbskin run --set`
    std::string needs;             // a body; where it is not installed the scene is left out
    int line = 0;                  // of its table, from 1
};

// A [[check.bound]]: low <= metric <= high in each of its frames.
struct CheckBound {
    std::string name, scene, deformer, metric;  // scene: a CheckScene's name; metric: a column of metrics.csv
    double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();  // in the metric's unit
    std::vector<int> frames;                                                                                // first and last; empty: all
    std::string why;  // reason for the bound, in words
    int line = 0;     // of its table, from 1
};

// A figure is as before when |now - then| <= absolute + relative |then|.
struct CheckTolerance {
    std::string metric;                     // a column of metrics.csv
    double absolute = 0.0, relative = 0.0;  // in the metric's unit; a share. Both finite, >= 0
    std::string why;                        // reason for the tolerance, in words
    int line = 0;                           // of its table, from 1; 0: of a count, which is compared exactly
};

// A file, read and checked.
struct CheckRules {
    std::string file;                        // for messages
    std::vector<CheckScene> scenes;          // at least one, each name once
    std::vector<CheckBound> bounds;          // each name once; may be empty
    std::vector<CheckTolerance> tolerances;  // one a metric at most
};

// InputError with file and line for broken TOML, unknown or missing keys, metrics that are not among `metrics` or are wall time, bounds of
// scenes that are not named, names twice, bounds that nothing can meet.
CheckRules parse_check_rules(const std::string& text, const std::string& file, const std::vector<std::string>& metrics);

}  // namespace analysis

// What a check measures and holds: scenes, bounds on their frames, tolerances of the comparison with a baseline. As data in TOML; the keys
// are documented at [[check.scene]] in experiments/claims.toml.
//   const CheckRules rules = parse_check_rules(text, "check.toml", known_metrics);
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace analysis {

struct CheckScene {
    std::string name;              // what bounds call it
    std::string scene;             // built in, or a file beside this one
    std::vector<std::string> set;  // key=value, as of `pbskin run --set`
    std::string needs;             // a body; where it is not installed the scene is left out
    int line = 0;
};

struct CheckBound {
    std::string name, scene, deformer, metric;
    double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
    std::vector<int> frames;  // first and last; empty: all
    std::string why;
    int line = 0;
};

// A figure is as before when |now - then| <= absolute + relative |then|.
struct CheckTolerance {
    std::string metric;
    double absolute = 0.0, relative = 0.0;
    std::string why;
    int line = 0;
};

struct CheckRules {
    std::string file;
    std::vector<CheckScene> scenes;
    std::vector<CheckBound> bounds;
    std::vector<CheckTolerance> tolerances;
};

// InputError with file and line for broken TOML, unknown or missing keys, metrics that are not among `metrics` or are wall time, bounds of
// scenes that are not named, names twice, bounds that nothing can meet.
CheckRules parse_check_rules(const std::string& text, const std::string& file, const std::vector<std::string>& metrics);

}  // namespace analysis

// `pbskin check`: real scenes are run, and what they measured is held against bounds and against a baseline.
//   const CheckResult result = run_check({.folder = "results/check"});
#pragma once

#include "analysis/check/check_case.hpp"

#include <string>
#include <vector>

namespace experiments {

struct CheckArguments {
    std::string folder = "results/check";
    std::string bounds = {};          // a file of scenes and bounds; empty: the project's own, experiments/verdicts/claims.toml
    std::string baseline = {};        // a file; empty: the project's own beside its own bounds, else none
    std::string write_baseline = {};  // a file; nothing is compared then
    bool require_all = false;         // refuse to leave out a scene
    int threads = 1;
};

struct CheckResult {
    std::vector<analysis::CheckSuite> suites;  // one a scene
    std::vector<std::string> breakdowns;
};

// Records of each scene in FOLDER/SCENE, FOLDER/check.json last. InputError for bad bounds, baseline or scenes, and where no scene's body
// is installed.
CheckResult run_check(const CheckArguments& arguments);

}  // namespace experiments

// `pbskin check`: runs real scenes and compares their metrics with bounds and with a baseline.
//   const CheckResult result = run_check({.folder = "results/check"});
#pragma once

#include "analysis/check/check.hpp"

#include <string>
#include <vector>

namespace experiments {

// The reports of `pbskin check` and `pbskin measure` on their bounds: on the terminal, for JUnit and for GitHub.
struct CheckReports {
    std::string junit = {};  // a file; empty: none
    bool github =
        false;  // annotations on stdout (also if GITHUB_ACTIONS is true), and a summary in the file GITHUB_STEP_SUMMARY
};

// Logs what does not hold or was left out, one line each.
void report_failures(const std::vector<analysis::CheckSuite>& suites);

// To be called before the work: InputError with the system's reason if a report cannot be written.
void require_writable(const CheckReports& reports);

void write_reports(const CheckReports& reports, const std::vector<analysis::CheckSuite>& suites);

struct CheckArguments {
    std::string folder = "results/check";
    // a file of scenes and bounds; empty: that of the project, experiments/verdicts/claims.toml
    std::string bounds = {};
    std::string baseline = {};        // a file; empty: that of the project with the project's bounds, else none
    std::string write_baseline = {};  // a file; then nothing is compared
    bool require_all = false;         // refuses to leave out a scene
    int threads = 1;
};

struct CheckResult {
    std::vector<analysis::CheckSuite> suites;  // one per scene
    std::vector<std::string> breakdowns;
};

// Writes the records of each scene into FOLDER/SCENE, and FOLDER/check.json last. InputError for bad bounds, baseline
// or scenes, and if no body of the scenes is installed.
CheckResult run_check(const CheckArguments& arguments);

}  // namespace experiments

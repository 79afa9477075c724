// The reports of `pbskin check` and `pbskin measure` on their bounds: on the terminal, for JUnit and for GitHub.
#pragma once

#include "analysis/check/check_report.hpp"

namespace experiments {

struct CheckReports {
    std::string junit = {};  // a file; empty: none
    bool github = false;     // annotations on stdout (also if GITHUB_ACTIONS is true), and a summary in the file GITHUB_STEP_SUMMARY
};

// Logs what does not hold or was left out, one line each.
void report_failures(const std::vector<analysis::CheckSuite>& suites);

// To be called before the work: InputError with the system's reason if a report cannot be written.
void require_writable(const CheckReports& reports);

void write_reports(const CheckReports& reports, const std::vector<analysis::CheckSuite>& suites);

}  // namespace experiments

// Where `pbskin check` and `pbskin measure` tell what became of their bounds: terminal, JUnit, GitHub.
#pragma once

#include "analysis/check/check_case.hpp"

namespace experiments {

struct CheckReports {
    std::string junit = {};  // a file; empty: none
    bool github = false;     // annotations on stdout, also where GITHUB_ACTIONS is true; with GITHUB_STEP_SUMMARY a summary is added to it
};

// On stderr, one line each, what does not hold or was left out.
void tell_failures(const std::vector<analysis::CheckSuite>& suites);

// To be asked before the work: InputError with the system's reason where a report cannot be written.
void require_writable(const CheckReports& reports);

void write_reports(const CheckReports& reports, const std::vector<analysis::CheckSuite>& suites);

}  // namespace experiments

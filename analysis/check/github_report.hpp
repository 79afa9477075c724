// What GitHub shows of a check: annotations at the lines of the bounds (workflow commands on stdout) and the job's summary.
#pragma once

#include "analysis/check/check_case.hpp"

namespace analysis {

// ::error file=FILE,line=N,title=SUITE NAME::MESSAGE for what does not hold, ::warning for what was left out; one line each.
std::string github_annotations(const std::vector<CheckSuite>& suites);

// Markdown: the cases as a table.
std::string github_summary(const std::vector<CheckSuite>& suites);

}  // namespace analysis

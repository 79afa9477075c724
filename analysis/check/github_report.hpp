// A check as GitHub shows it: annotations at the lines of the bounds (workflow commands on stdout) and the summary of the job.
#pragma once

#include "analysis/check/check_case.hpp"

namespace analysis {

// ::error file=FILE,line=N,title=SUITE NAME::MESSAGE for cases that fail, ::warning for cases that were left out; one line each.
std::string github_annotations(const std::vector<CheckSuite>& suites);

// A Markdown table of the cases.
std::string github_summary(const std::vector<CheckSuite>& suites);

}  // namespace analysis

// JUnit XML for CI servers: one testsuite per suite and one testcase per case (classname: the name of the suite), with its wall time.
// <failure> marks a case that fails, <error> a breakdown or a refused frame, <skipped> a case that was left out.
//   write_text_atomically(path, junit_report(suites));
#pragma once

#include "analysis/check/check_case.hpp"

namespace analysis {

// The whole document, with counts and seconds for each suite and in total.
std::string junit_report(const std::vector<CheckSuite>& suites);

}  // namespace analysis

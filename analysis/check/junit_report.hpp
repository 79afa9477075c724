// JUnit XML as CI servers read it: a testsuite a suite, a testcase a case (classname: the suite's name), its wall time; <failure> for what
// does not hold, <error> for a breakdown or a refused frame, <skipped> for what was left out.
//   write_text_atomically(path, junit_report(suites));
#pragma once

#include "analysis/check/check_case.hpp"

namespace analysis {

// The whole document; counts and seconds of each suite and of all.
std::string junit_report(const std::vector<CheckSuite>& suites);

}  // namespace analysis

// One requirement on a run or on a frame from elsewhere, and its result, as the terminal, JUnit, GitHub and check.json show it.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace analysis {

// failed: a bound does not hold; broke_down: the run is not finite; refused: the input is invalid.
enum class CheckState { held, failed, left_out, broke_down, refused };

// A case that holds has a message too.
struct CheckCase {
    std::string suite;                    // name of the scene, or of the rest mesh
    std::string name;                     // name of the bound
    CheckState state = CheckState::held;  // the result
    std::string message;                  // one line; for a failure: the frame, the metric, its value and the bound
    std::optional<int> frame;             // the worst frame
    std::optional<double> value = {};     // value in that frame
    std::string file;                     // file that declares the bound; empty: the command line
    int line = 0;                         // in that file, from 1; 0: none
    double seconds = 0.0;                 // wall time; recorded but never judged
};

// The cases of one suite, in their order.
struct CheckSuite {
    std::string name;                                             // name of the scene, or of the rest mesh
    double seconds = 0.0;                                         // wall time of the whole suite
    std::vector<std::pair<std::string, std::string>> properties;  // name, value
    std::vector<CheckCase> cases;                                 // one per bound, and one per deformer of the baseline
};

int count(const std::vector<CheckSuite>& suites, CheckState state);  // summed over all suites
const char* to_string(CheckState state);                             // "holds", "FAILS", "left out", "BREAKDOWN", "REFUSED"

// A table for the terminal with one line per case and its message.
std::string check_table(const std::vector<CheckSuite>& suites);

// A check as GitHub shows it: annotations at the lines of the bounds (workflow commands on stdout) and the summary of the job.

// ::error file=FILE,line=N,title=SUITE NAME::MESSAGE for cases that fail, ::warning for cases that were left out; one line each.
std::string github_annotations(const std::vector<CheckSuite>& suites);

// A Markdown table of the cases.
std::string github_summary(const std::vector<CheckSuite>& suites);

// JUnit XML for CI servers: one testsuite per suite and one testcase per case (classname: the name of the suite), with its wall time.
// <failure> marks a case that fails, <error> a breakdown or a refused frame, <skipped> a case that was left out.
//   write_text_atomically(path, junit_report(suites));

// The whole document, with counts and seconds for each suite and in total.
std::string junit_report(const std::vector<CheckSuite>& suites);

}  // namespace analysis

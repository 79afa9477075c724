// One thing that was asked of a run or of a foreign frame, and what became of it: what the terminal, JUnit, GitHub and check.json show.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace analysis {

// failed: a bound does not hold; broke_down: the run is not finite; refused: bad input.
enum class CheckState { held, failed, left_out, broke_down, refused };

// A held case has its message too.
struct CheckCase {
    std::string suite;                    // the scene, or the rest mesh
    std::string name;                     // of the bound
    CheckState state = CheckState::held;  // what became of it
    std::string message;                  // one line; of a failure: the frame, the metric, its value and the bound
    std::optional<int> frame;             // the worst one
    std::optional<double> value = {};     // there
    std::string file;                     // where the bound stands; empty: on the command line
    int line = 0;                         // in that file, from 1; 0: none
    double seconds = 0.0;                 // wall time; tracked, never judged
};

// Cases of one suite in their order.
struct CheckSuite {
    std::string name;                                             // the scene, or the rest mesh
    double seconds = 0.0;                                         // wall time of the whole
    std::vector<std::pair<std::string, std::string>> properties;  // name, value
    std::vector<CheckCase> cases;                                 // one a bound, and one a deformer of the baseline
};

int count(const std::vector<CheckSuite>& suites, CheckState state);  // over all suites
const char* to_string(CheckState state);                             // "holds", "FAILS", "left out", "BREAKDOWN", "REFUSED"

// For the terminal: one line a case, with its message.
std::string check_table(const std::vector<CheckSuite>& suites);

}  // namespace analysis

// What the program's exit status says.
#pragma once

namespace experiments {

enum ExitStatus {
    exit_finished = 0,
    exit_bound = 1,         // a bound does not hold, or a verdict could not be computed
    exit_internal = 1,      // an error of the program's own
    exit_input = 2,         // bad input or usage
    exit_breakdown = 3,     // numerical breakdown in a run that was expected to finish
    exit_interrupted = 130  // what was finished is kept
};

}  // namespace experiments

// The program's exit status, and what an exception means: a text for stderr and an exit status.
//   try { ... } catch (...) { const Failure failure = caught_failure(); }
#pragma once

#include <string>

namespace experiments {

enum ExitStatus {
    exit_finished = 0,
    exit_bound = 1,         // a bound does not hold, or a verdict could not be computed
    exit_internal = 1,      // an error of the program itself
    exit_input = 2,         // bad input or usage
    exit_breakdown = 3,     // numerical breakdown in a run that was expected to finish
    exit_interrupted = 130  // finished work is kept
};

struct Failure {
    std::string words;
    ExitStatus status = exit_internal;

    std::string message() const;  // one line for stderr, without the program's name
};

// To be called in a catch, for the exception that is being handled. The user can mend bad input, a failing disk and too little memory
// (exit_input). Any other exception is an internal error, and its message says so.
Failure caught_failure();

}  // namespace experiments

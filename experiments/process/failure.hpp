// What an exception means to whoever started the work: its words for stderr and the exit status.
//   try { ... } catch (...) { const Failure failure = caught_failure(); }
#pragma once

#include "experiments/process/exit_status.hpp"

#include <string>

namespace experiments {

struct Failure {
    std::string words;
    ExitStatus status = exit_internal;

    std::string message() const;  // a line for stderr, without the program's name
};

// Of the exception that is being handled: inside a catch. Bad input, a place on disk that refuses and too little memory are the user's to
// mend, exit_input; what nobody has foreseen is an internal error, and its message says so.
Failure caught_failure();

}  // namespace experiments

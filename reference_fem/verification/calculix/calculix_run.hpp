// CalculiX as a child process: one thread, a folder of its own, a time limit.
//   if (const auto program = calculix_on_path()) run_calculix(*program, deck, {});
#pragma once

#include <functional>
#include <iosfwd>
#include <optional>
#include <string>

namespace reference_fem {

struct CalculixLimits {
    double seconds = 300.0;
};

enum class CalculixOutcome {
    finished,
    refused,      // it ended with an error, by its exit status or its output
    out_of_time,  // killed
    not_started,
};
const char* name_of(CalculixOutcome outcome);

// CalculiX's files and output; calculix_result.hpp reads the solution from them.
struct CalculixRun {
    CalculixOutcome outcome = CalculixOutcome::not_started;
    double wall_s = 0.0;  // from the start of the process to its end, reading and writing of its files included
    double cpu_s = 0.0;   // user and system time
    std::string output;   // standard output and error
    std::string printed;  // deck.dat
    std::string restart;  // deck.rout, binary
};

// The end of a program's output, which states its error.
std::string last_words(const std::string& output);

// The program `ccx` on the PATH, if there is one.
std::optional<std::string> calculix_on_path();

// "CalculiX 2.20", or "unknown version".
std::string calculix_version(const std::string& program);

// write_deck writes the deck to a stream; the folder is removed afterwards.
CalculixRun run_calculix(const std::string& program, const std::function<void(std::ostream&)>& write_deck, const CalculixLimits& limits);

}  // namespace reference_fem

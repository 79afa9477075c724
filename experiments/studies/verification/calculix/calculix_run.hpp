// CalculiX as a child process: one thread, a folder of its own, a time limit.
//   if (const auto program = calculix_on_path()) run_calculix(*program, deck, {});
#pragma once

#include <functional>
#include <iosfwd>
#include <optional>
#include <string>

namespace experiments {

struct CalculixLimits {
    double seconds = 300.0;
};

enum class CalculixOutcome {
    finished,
    refused,      // it ended with an error, by its exit status or in its own words
    out_of_time,  // killed
    not_started,
};
const char* name_of(CalculixOutcome outcome);

// What it left behind; whether that holds a solution is for calculix_result.hpp to say.
struct CalculixRun {
    CalculixOutcome outcome = CalculixOutcome::not_started;
    double wall_s = 0.0;  // from the start of the process to its end, reading and writing of its files included
    double cpu_s = 0.0;   // user and system time
    std::string output;   // what it said
    std::string printed;  // deck.dat
    std::string restart;  // deck.rout, binary
};

// The end of what a program said, where its error stands.
std::string last_words(const std::string& output);

// The program `ccx` on the PATH, if there is one.
std::optional<std::string> calculix_on_path();

// "CalculiX 2.20", or what the program said instead.
std::string calculix_version(const std::string& program);

// write_deck writes the deck to a stream; the folder is removed afterwards.
CalculixRun run_calculix(const std::string& program, const std::function<void(std::ostream&)>& write_deck, const CalculixLimits& limits);

}  // namespace experiments

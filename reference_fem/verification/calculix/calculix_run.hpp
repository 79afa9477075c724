// CalculiX as a child process: one thread, a folder of its own, a time limit.
//   if (const auto program = calculix_on_path()) run_calculix(*program, deck, {});
#pragma once

#include "pbs/geometry/tet_mesh.hpp"
#include "reference_fem/verification/calculix/calculix_deck.hpp"

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

// CalculiX's files and output, from which read_displacements reads the solution.
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

// Displacements from CalculiX's files. It prints 7 digits (deck.dat); its restart file (deck.rout, *RESTART, WRITE: Fortran records
// of raw memory) holds them in double. Which record of it they are depends on CalculiX's version, so it is recognised: the one of the
// right length that agrees with every printed number to its last digit. The ends of springs, which are not printed, are nodes behind them.
struct CalculixDisplacements {
    pbs::Positions displacements;  // [m], #nodes x 3
    bool in_double = false;        // from the restart file; false: 7 digits, as printed
};

// The one block of displacements in a .dat text, at time 1. pbs::InputError with `file` and line where there is none or a second one, a
// node is missing, twice or unknown, or a line is not a node and three numbers.
pbs::Positions read_printed_displacements(const std::string& text, const std::string& file, Eigen::Index nodes);

// Both; a restart file that is empty or holds no such record leaves the printed digits. pbs::InputError where it is cut short.
CalculixDisplacements read_displacements(const std::string& printed, const std::string& restart, Eigen::Index nodes);

// CalculiX's answer to a problem that the reference has solved, compared node by node.
//   const SecondOpinion opinion = second_opinion(*calculix_on_path(), answered_cantilever(mesh, 1, {}));
struct SecondOpinion {
    CalculixOutcome outcome = CalculixOutcome::not_started;  // finished: the numbers below are set
    std::string last_words;                                  // the end of CalculiX's output, where it did not finish
    double wall_s = 0.0;
    bool in_double = false;               // its displacements were read in double; false: 7 digits
    double largest_displacement_m = 0.0;  // the reference's
    double largest_difference_m = 0.0;    // of a node's displacement vector
    int node = -1;                        // where

    double relative_difference() const { return largest_difference_m / largest_displacement_m; }
};

// pbs::InputError where CalculiX's files are damaged.
SecondOpinion second_opinion(const std::string& program, const AnsweredProblem& ours, const DeckOptions& options = {},
                             const CalculixLimits& limits = {});

}  // namespace reference_fem

// The program and its user: exit statuses and failures, interruption, and the terminal with its width, colours,
// progress and warnings.
#pragma once

#include "pbs/geometry/cost.hpp"

#include <sys/types.h>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace experiments {

// The program's exit status, and what an exception means: a text for stderr and an exit status.
//   try { ... } catch (...) { const Failure failure = caught_failure(); }
enum ExitStatus {
    exit_finished = 0,
    exit_bound = 1,         // a bound does not hold, results differ, or a verdict could not be computed
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

// To be called in a catch, for the exception that is being handled. The user can mend bad input, a failing disk and too
// little memory (exit_input). Any other exception is an internal error, and its message states this.
Failure caught_failure();

// SIGINT and SIGTERM end this process and its child processes at once, with exit_interrupted: records are written whole
// or not at all. Unfinished files are removed. SIGTERM waits while METIS orders a matrix
// (pbs/system/deferred_sigterm.hpp). The names of long stages are printed.
void watch_interrupts();

// While it exists, the first signal is only noted, for work that looks for it several times a second. The next one ends
// the process. Child processes end at the first.
//   const NotedInterrupts noted;  ...  stop_if_interrupted();
class NotedInterrupts {
public:
    NotedInterrupts();
    ~NotedInterrupts();
    NotedInterrupts(const NotedInterrupts&) = delete;
    NotedInterrupts& operator=(const NotedInterrupts&) = delete;

private:
    pid_t around_;
};

struct Interrupted {};

bool interrupted();
void stop_if_interrupted();  // throws Interrupted
// What an interruption that ends the program prints, in place of an earlier text.
void say_when_interrupted(const std::string& text);
// For work that an interruption shortens rather than ends: returns whether there was one, says so, and forgets it.
bool take_interruption();

// The number of characters in a line: COLUMNS, else the width of the terminal, else 100.
std::size_t terminal_width();

// False if NO_COLOR is set. Otherwise CLICOLOR_FORCE decides (any value except 0: true), and if that is not set,
// whether standard output is a terminal.
bool terminal_has_colours();

// A progress bar with the time left, on stderr if that is a terminal.
class Progress {
public:
    Progress(std::string label, int total);
    ~Progress();
    void advance_to(int done);
    void advance_to(int done, const std::string& words);  // in place of the time left

private:
    std::string label_;
    int total_;
    bool shown_;
    double last_drawn_s_ = -1.0;
    pbs::Stopwatch stopwatch_;
};

void hide_progress();  // for --quiet and in worker processes
void show_progress();  // undoes hide_progress

// Warnings on stderr about input that was accepted after a treatment: `pbskin: warning: FILE: FIELD = VALUE:
// treatment`. --quiet hides them.
void warn(const std::vector<std::string>& remarks);

// While it exists, the warnings of this process and of those that it forks go to a file instead of the terminal. The
// end of a long run names the file, which then has each warning once with its count.
//   CollectedWarnings warnings(folder + "/warnings.txt");  ...  fmt::print("{}", warnings.summary());
class CollectedWarnings {
public:
    explicit CollectedWarnings(const std::string& file);  // its folder exists; InputError if the file cannot be written
    ~CollectedWarnings();
    CollectedWarnings(const CollectedWarnings&) = delete;
    CollectedWarnings& operator=(const CollectedWarnings&) = delete;

    void add(const std::string& text);
    // "Warnings: 3, in results/reproduce/warnings.txt\n"; empty without any, and then there is no file.
    std::string summary();

private:
    class Sink;
    std::string file_;
    std::shared_ptr<Sink> sink_;
    bool is_summed_up_ = false;
};

}  // namespace experiments

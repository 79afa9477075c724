// Child processes: work in a process of its own, other programs, and a pool of workers.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace experiments {

// Work in a process of its own, which has its own peak memory, loaded libraries and breakdowns.
//   const nlohmann::json cost = in_own_process([&] { return cost_of(scene); });
// Returns what the work returns. An InputError of the work is thrown here with the same text, any other exception as a
// std::runtime_error. InputError if the process ended by a signal. Interrupted if this process is interrupted, which
// ends the other one.
nlohmann::json in_own_process(const std::function<nlohmann::json()>& work);

// Runs another program, found on the PATH, without a shell.
//   const ProgramRun packed = run_program({"npm", "pack", "name@1.0.0"}, folder);
struct ProgramRun {
    bool started = false;
    int status = -1;         // its exit status; minus the number of the signal that ended it; -1: it did not start
    std::string last_words;  // the end of its output; the reason if it did not start

    bool succeeded() const { return started && status == 0; }
};

// The program runs in `folder`, which must exist. Its output is in a file there while it runs. Without a folder, it
// runs in the current one and writes where this process does. An interruption asks it to end, and kills it half a
// second later if it may be killed.
ProgramRun run_program(const std::vector<std::string>& program_and_arguments, const std::optional<std::string>& folder,
                       bool may_be_killed = true);

// Returns why the program, a path or a name on the PATH, cannot be started, or an empty text if it can. Relative paths
// and relative entries of the PATH count as missing, for run_program changes to its folder before it seeks the program.
std::string why_not_startable(const std::string& program);

// Runs in parallel, each in a process of its own: a failure of a library stays in its run, and all memory is given
// back. Workers end with this process, however it ends.
struct PooledWork {
    std::string name;
    double cost_s = 0.0;  // expected, on one core
    // runs in the worker; returns what broke down numerically, or ""; an exception is a failure
    std::function<std::string()> action;
};

struct PooledResult {
    std::string name;
    bool finished = false;
    std::string breakdown;  // numerical; the run is finished and recorded nevertheless
    std::string failure;    // the worker's message, or the signal that ended it
    bool refused = false;   // the failure is an InputError: bad input, or a file that cannot be written
};

// Runs at most `jobs` at once, the costliest first. The results are in the order of `work`. Logs each end with the time
// left by the expected costs. then_s: expected wall time of the work that follows this [s].
std::vector<PooledResult> run_in_pool(const std::vector<PooledWork>& work, int jobs, double then_s = 0.0);

}  // namespace experiments

// Runs in parallel, each in a process of its own: a failure of a library stays in its run, and all memory is given back. Workers end with
// this process, however it ends.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace experiments {

struct PooledWork {
    std::string name;
    double cost_s = 0.0;                  // expected, on one core
    std::function<std::string()> action;  // runs in the worker; returns what broke down numerically, or ""; an exception is a failure
};

struct PooledResult {
    std::string name;
    bool finished = false;
    std::string breakdown;  // numerical; the run is finished and recorded nevertheless
    std::string failure;    // the worker's message, or the signal that ended it
    bool refused = false;   // the failure is an InputError: bad input, or a file that cannot be written
    double cpu_s = 0.0;     // processor time that it took
};

// Runs at most `jobs` at once, the costliest first. The results are in the order of `work`. Logs each end with the time left by the
// expected costs. then_s: expected wall time of the work that follows this [s].
std::vector<PooledResult> run_in_pool(const std::vector<PooledWork>& work, int jobs, double then_s = 0.0);

}  // namespace experiments

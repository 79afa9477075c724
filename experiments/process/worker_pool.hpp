// Runs side by side, each in a process of its own: a breakdown of a library stays in its run, and memory is given back. Workers end with
// this process, however it ends.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace experiments {

struct PooledWork {
    std::string name;
    double cost_s = 0.0;                  // expected
    std::function<std::string()> action;  // runs in the worker; says what broke down numerically, if anything; an exception is its failure
};

struct PooledResult {
    std::string name;
    bool finished = false;
    std::string breakdown;  // numerical, of a run that is finished and recorded all the same
    std::string failure;    // what the worker said, or how it died
    bool refused = false;   // the failure is an InputError: bad input, or a file that cannot be written
    double cpu_s = 0.0;     // that it took, of one core
};

// At most `jobs` at once, the costliest first; results in the order of `work`. Reports each that ends, with the time left by their expected
// costs; then_s: what is expected of the work after this, wall time [s].
std::vector<PooledResult> run_in_pool(const std::vector<PooledWork>& work, int jobs, double then_s = 0.0);

}  // namespace experiments

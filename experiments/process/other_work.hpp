// The processors that other work keeps busy, measured while this thread sleeps.
//   const double busy = busy_processors(0.5);   // 1 if another program computes on one core
#pragma once

#include <optional>
#include <string>

namespace experiments {

// The processor time of a machine, summed over its processors, in ticks of the kernel.
struct ProcessorTicks {
    double busy = 0.0;  // waiting for a disk is idle; time that a host takes for other guests is busy
    double idle = 0.0;
    int processors = 0;
};

// Reads the text of /proc/stat (proc(5)). Returns nothing if no line "cpu" has at least four numbers, or if no processor is listed.
std::optional<ProcessorTicks> processor_ticks(const std::string& proc_stat);

// Returns the mean number of busy processors between two moments, or nothing if no tick lies between them.
std::optional<double> busy_processors(const ProcessorTicks& before, const ProcessorTicks& after);

// Measures while it sleeps for `seconds`. Returns nothing if the system does not report its processors, or if no tick passes meanwhile.
std::optional<double> busy_processors(double seconds);

}  // namespace experiments

#include "experiments/process/peak_memory.hpp"

#include <malloc.h>

#include <fstream>
#include <string>

namespace experiments {
namespace {

// A line of /proc/self/status, such as "VmHWM:   4321 kB".
double status_bytes(const std::string& field)
{
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.rfind(field + ":", 0) == 0) return 1024.0 * std::stod(line.substr(field.size() + 1));
    return 0.0;
}

}  // namespace

PeakMemory peak_memory_of(const std::function<void()>& work)
{
    malloc_trim(0);                               // memory that earlier work has freed does not count
    std::ofstream("/proc/self/clear_refs") << 5;  // resets the peak (proc(5))
    PeakMemory memory{status_bytes("VmRSS"), 0.0};
    work();
    memory.peak_bytes = peak_memory_bytes();
    return memory;
}

double peak_memory_bytes()
{
    return status_bytes("VmHWM");
}

}  // namespace experiments

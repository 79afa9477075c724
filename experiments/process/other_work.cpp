#include "experiments/process/other_work.hpp"

#include <cctype>
#include <chrono>
#include <fstream>
#include <iterator>
#include <sstream>
#include <thread>
#include <vector>

namespace experiments {
namespace {

// The columns of a line "cpu" (proc(5)). The guests' times, which follow, are contained in user and nice.
enum Column { user, nice, system, idle, iowait, irq, softirq, steal, columns };

std::optional<ProcessorTicks> ticks_now()
{
    std::ifstream file("/proc/stat");
    return processor_ticks({std::istreambuf_iterator<char>(file), {}});
}

}  // namespace

std::optional<ProcessorTicks> processor_ticks(const std::string& proc_stat)
{
    std::vector<double> ticks;
    int processors = 0;
    std::istringstream text(proc_stat);
    for (std::string line; std::getline(text, line);) {
        std::istringstream words(line);
        std::string name;
        words >> name;
        if (name == "cpu") ticks.assign(std::istream_iterator<double>(words), {});
        if (name.size() > 3 && name.rfind("cpu", 0) == 0 && std::isdigit(static_cast<unsigned char>(name[3]))) ++processors;
    }
    if (ticks.size() <= idle || processors == 0) return std::nullopt;
    ticks.resize(columns, 0.0);
    return ProcessorTicks{ticks[user] + ticks[nice] + ticks[system] + ticks[irq] + ticks[softirq] + ticks[steal],
                          ticks[idle] + ticks[iowait], processors};
}

std::optional<double> busy_processors(const ProcessorTicks& before, const ProcessorTicks& after)
{
    const double busy = after.busy - before.busy, all = busy + after.idle - before.idle;
    if (!(all > 0.0)) return std::nullopt;
    return after.processors * busy / all;
}

std::optional<double> busy_processors(double seconds)
{
    const std::optional<ProcessorTicks> before = ticks_now();
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
    const std::optional<ProcessorTicks> after = ticks_now();
    if (!before || !after) return std::nullopt;
    return busy_processors(*before, *after);
}

}  // namespace experiments

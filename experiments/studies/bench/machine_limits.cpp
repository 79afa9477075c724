#include "experiments/studies/bench/machine_limits.hpp"

#include "experiments/process/machine.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace experiments {
namespace {

constexpr int turns = 3;
constexpr double smallest_bytes = 16 * 1024.0;

// The largest amount of work per second over the turns. work(repeats) does the work and returns its amount; the number of repeats is chosen
// so that they take about `seconds`.
template <typename Work>
double best_rate(double seconds, const Work& work)
{
    double best = 0.0;
    std::size_t repeats = 1;
    for (int turn = 0; turn < turns;) {
        const double start = thread_cpu_s();
        const double done = work(repeats);
        const double took = thread_cpu_s() - start;
        if (took < 0.7 * seconds && turn == 0) {
            repeats = std::max(repeats + 1, static_cast<std::size_t>(double(repeats) * std::min(10.0, seconds / std::max(took, 1e-7))));
            continue;
        }
        best = std::max(best, done / std::max(took, 1e-9));
        ++turn;
    }
    return best;
}

// From one half of the working set to the other.
double copy_gb_s(std::vector<float>& numbers, double seconds)
{
    const std::size_t half = numbers.size() / 2;
    return 1e-9 * best_rate(seconds, [&](std::size_t repeats) {
               for (std::size_t repeat = 0; repeat < repeats; ++repeat) {
                   std::memcpy(&numbers[0], &numbers[half], half * sizeof(float));
                   asm volatile("" ::: "memory");  // so that no repetition is left out
               }
               return 2.0 * double(repeats) * double(half) * sizeof(float);
           });
}

double update_gb_s(std::vector<float>& numbers, double seconds)
{
    volatile float one = 1.0f;  // unknown to the compiler
    return 1e-9 * best_rate(seconds, [&](std::size_t repeats) {
               for (std::size_t repeat = 0; repeat < repeats; ++repeat) {
                   const float factor = one;
                   for (float& number : numbers) number *= factor;
               }
               return 2.0 * double(repeats) * double(numbers.size()) * sizeof(float);
           });
}

MemoryBandwidth bandwidth_of(double bytes, double seconds)
{
    std::vector<float> numbers(static_cast<std::size_t>(bytes / sizeof(float)), 1.0f);
    return {bytes, std::max(copy_gb_s(numbers, seconds), update_gb_s(numbers, seconds))};
}

}  // namespace

MachineLimits measure_limits(double seconds, double largest_bytes)
{
    MachineLimits limits;
    for (double bytes = smallest_bytes; bytes < 1.5 * largest_bytes; bytes *= 2.0) limits.memory.push_back(bandwidth_of(bytes, seconds));
    return limits;
}

double bandwidth_at(const MachineLimits& limits, double bytes)
{
    const auto& memory = limits.memory;
    if (memory.empty()) return 0.0;
    const auto above = std::find_if(memory.begin(), memory.end(), [&](const MemoryBandwidth& point) { return point.bytes >= bytes; });
    if (above == memory.begin()) return memory.front().gb_s;
    if (above == memory.end()) return memory.back().gb_s;
    const MemoryBandwidth &low = *(above - 1), &high = *above;
    return std::lerp(low.gb_s, high.gb_s, std::log(bytes / low.bytes) / std::log(high.bytes / low.bytes));
}

}  // namespace experiments

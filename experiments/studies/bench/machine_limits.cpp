#include "experiments/studies/bench/machine_limits.hpp"

#include "experiments/process/machine.hpp"
#include "experiments/studies/bench/machine_kernels.hpp"

#include <algorithm>
#include <cmath>

namespace experiments {
namespace {

constexpr int turns = 3;
constexpr double smallest_bytes = 16 * 1024.0;

constexpr std::size_t floats_a_line = 16;

struct alignas(64) CacheLine {
    float floats[floats_a_line];
};

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

template <typename Scalar>
double peak_gflops(double seconds)
{
    volatile Scalar start = Scalar(1), a = Scalar(0.999), b = Scalar(0.001);  // unknown to the compiler
    volatile Scalar sink = Scalar(0);
    return 1e-9 * best_rate(seconds, [&](std::size_t repeats) {
               Scalar sum;
               const double flops = multiply_add<Scalar>(1000 * repeats, start, a, b, sum);
               sink = sum;
               return flops;
           });
}

// From one half of the working set to the other.
double copy_gb_s(std::vector<CacheLine>& lines, double seconds)
{
    const std::size_t half = lines.size() / 2;
    const std::size_t count = floats_a_line * half / 64 * 64;
    return 1e-9 * best_rate(seconds, [&](std::size_t repeats) {
               for (std::size_t repeat = 0; repeat < repeats; ++repeat) copy_floats(lines[0].floats, lines[half].floats, count);
               return 2.0 * double(repeats) * double(count) * sizeof(float);
           });
}

double update_gb_s(std::vector<CacheLine>& lines, double seconds)
{
    const std::size_t count = floats_a_line * lines.size() / 64 * 64;
    volatile float one = 1.0f;  // unknown to the compiler
    return 1e-9 * best_rate(seconds, [&](std::size_t repeats) {
               for (std::size_t repeat = 0; repeat < repeats; ++repeat) scale_floats(one, lines[0].floats, count);
               return 2.0 * double(repeats) * double(count) * sizeof(float);
           });
}

MemoryBandwidth bandwidth_of(double bytes, double seconds)
{
    std::vector<CacheLine> lines(static_cast<std::size_t>(bytes / sizeof(CacheLine)), CacheLine{{1.0f}});
    return {bytes, std::max(copy_gb_s(lines, seconds), update_gb_s(lines, seconds))};
}

}  // namespace

MachineLimits measure_limits(double seconds, double largest_bytes)
{
    MachineLimits limits;
    limits.gflops_f32 = peak_gflops<float>(seconds);
    limits.gflops_f64 = peak_gflops<double>(seconds);
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

double attainable_gflops(double peak_gflops, double gb_s, double flops_per_byte)
{
    return std::min(peak_gflops, gb_s * flops_per_byte);
}

}  // namespace experiments

#include "experiments/studies/bench/machine_limits.hpp"

#include "experiments/process/cpu_clock.hpp"
#include "experiments/studies/bench/machine_kernels.hpp"

#include <algorithm>
#include <cmath>

namespace experiments {
namespace {

constexpr int turns = 3;
constexpr double smallest_bytes = 16 * 1024.0;

struct alignas(64) CacheLine {
    float floats[16];
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

double copy_gb_s(double bytes, double seconds)
{
    const std::size_t count = static_cast<std::size_t>(bytes / 2.0 / sizeof(float)) / 64 * 64;
    std::vector<CacheLine> from(count / 16, CacheLine{{1.0f}}), to = from;
    return 1e-9 * best_rate(seconds, [&](std::size_t repeats) {
               for (std::size_t repeat = 0; repeat < repeats; ++repeat) copy_floats(from[0].floats, to[0].floats, count);
               return 2.0 * double(repeats) * double(count) * sizeof(float);
           });
}

}  // namespace

MachineLimits measure_limits(double seconds, double largest_bytes)
{
    MachineLimits limits;
    limits.gflops_f32 = peak_gflops<float>(seconds);
    limits.gflops_f64 = peak_gflops<double>(seconds);
    for (double bytes = smallest_bytes; bytes < 1.5 * largest_bytes; bytes *= 2.0)
        limits.copy.push_back({bytes, copy_gb_s(bytes, seconds)});
    return limits;
}

double bandwidth_at(const MachineLimits& limits, double bytes)
{
    const auto& copy = limits.copy;
    if (copy.empty()) return 0.0;
    const auto above = std::find_if(copy.begin(), copy.end(), [&](const CopyBandwidth& point) { return point.bytes >= bytes; });
    if (above == copy.begin()) return copy.front().gb_s;
    if (above == copy.end()) return copy.back().gb_s;
    const CopyBandwidth &low = *(above - 1), &high = *above;
    return std::lerp(low.gb_s, high.gb_s, std::log(bytes / low.bytes) / std::log(high.bytes / low.bytes));
}

double attainable_gflops(double peak_gflops, double gb_s, double flops_per_byte)
{
    return std::min(peak_gflops, gb_s * flops_per_byte);
}

}  // namespace experiments

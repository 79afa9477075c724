// What one core of this machine can do at best: multiply-adds a second, and bytes a second copied between and within its caches and memory.
//   const MachineLimits limits = measure_limits(0.02);
//   bandwidth_at(limits, 2.5e6);   // GB/s of a loop that goes over 2.5 MB
#pragma once

#include <vector>

namespace experiments {

struct CopyBandwidth {
    double bytes = 0.0;  // working set: what is read and what is written
    double gb_s = 0.0;   // read and written, 1e9 bytes a second
};

struct MachineLimits {
    double gflops_f32 = 0.0, gflops_f64 = 0.0;  // a multiply-add is two operations
    std::vector<CopyBandwidth> copy;            // by growing working set
};

// The best of three turns of some `seconds` each, processor time: a limit is what is reached undisturbed. Working sets double from 16 KiB
// to `largest_bytes`, which should lie well beyond the last cache.
MachineLimits measure_limits(double seconds, double largest_bytes = 256e6);

// Linear in the logarithm of the working set between what was measured, constant beyond.
double bandwidth_at(const MachineLimits& limits, double bytes);

// The roofline: no loop of so many operations a byte does more than this, GFLOP/s.
double attainable_gflops(double peak_gflops, double gb_s, double flops_a_byte);

}  // namespace experiments

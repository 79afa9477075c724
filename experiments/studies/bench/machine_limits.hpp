// The limits of one core of this machine: bytes per second read and written within its caches and memory.
// The bandwidth is the larger one of a copy and of an update in place. Beyond the first cache a copy is the slower one, because the
// processor also loads the lines that the copy overwrites.
//   const MachineLimits limits = measure_limits(0.02);
//   bandwidth_at(limits, 2.5e6);   // GB/s of a loop over 2.5 MB
#pragma once

#include <vector>

namespace experiments {

struct MemoryBandwidth {
    double bytes = 0.0;  // working set
    double gb_s = 0.0;   // read and written, 1e9 bytes per second
};

struct MachineLimits {
    std::vector<MemoryBandwidth> memory;  // by growing working set
};

// The best of three turns of about `seconds` of processor time each, since a limit is reached only undisturbed. Working sets double from
// 16 KiB to `largest_bytes`, which should be well beyond the last cache.
MachineLimits measure_limits(double seconds, double largest_bytes = 256e6);

// Interpolates linearly in the logarithm of the working set; constant outside the measured sizes.
double bandwidth_at(const MachineLimits& limits, double bytes);

}  // namespace experiments

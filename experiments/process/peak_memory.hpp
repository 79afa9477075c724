// Resident memory of this process, as Linux counts it.
//   const PeakMemory memory = peak_memory_of([&] { solver.advance(...); });
#pragma once

#include <functional>

namespace experiments {

struct PeakMemory {
    double before_bytes = 0.0;
    double peak_bytes = 0.0;  // the maximum while the work ran; zero if the system does not report it

    double growth_bytes() const { return peak_bytes - before_bytes; }
};

PeakMemory peak_memory_of(const std::function<void()>& work);

double peak_memory_bytes();  // of this process since it started, or since peak_memory_of began

}  // namespace experiments

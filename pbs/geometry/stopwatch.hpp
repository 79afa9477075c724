// Wall time since construction [s].
#pragma once

#include <chrono>

namespace pbs {

// By the steady clock, which nobody sets back.
class Stopwatch {
public:
    // Since construction; may be asked again and again.
    double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace pbs

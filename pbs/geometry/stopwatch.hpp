// Wall time since construction [s].
#pragma once

#include <chrono>

namespace pbs {

// Uses the steady clock, which is never set back.
class Stopwatch {
public:
    // Time since construction; may be called repeatedly.
    double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace pbs

// Seconds of one phase: on the wall, and of this process's processor time. On a machine that others use the latter is the one to compare;
// a rank that waits for another polls, so its waiting counts in both.
#pragma once

#include "pbs/geometry/cost.hpp"

#include <ctime>

namespace reference_fem {

// cpu_s is the sum over the threads of the process.
struct PhaseTime {
    double wall_s = 0.0, cpu_s = 0.0;  // [s]
};

// Starts when it is made.
class PhaseClock {
public:
    PhaseTime elapsed() const { return {wall_.seconds(), processor_seconds() - start_}; }  // since the start; the clock runs on

private:
    static double processor_seconds()
    {
        std::timespec time{};
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
        return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
    }

    pbs::Stopwatch wall_;
    double start_ = processor_seconds();
};

}  // namespace reference_fem

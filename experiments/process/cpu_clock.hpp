// Processor time [s]: other work on the machine stretches it less than wall time.
#pragma once

#include <ctime>

namespace experiments {

inline double clock_s(clockid_t clock)
{
    timespec time{};
    clock_gettime(clock, &time);
    return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

// Processor time of the calling thread.
inline double thread_cpu_s()
{
    return clock_s(CLOCK_THREAD_CPUTIME_ID);
}

// Processor time of all threads of the process.
inline double process_cpu_s()
{
    return clock_s(CLOCK_PROCESS_CPUTIME_ID);
}

}  // namespace experiments

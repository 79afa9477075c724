// Processor time of the calling thread [s]: other work on the machine stretches it less than wall time.
#pragma once

#include <ctime>

namespace experiments {

inline double thread_cpu_s()
{
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

// The same of all threads of the process.
inline double process_cpu_s()
{
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

}  // namespace experiments

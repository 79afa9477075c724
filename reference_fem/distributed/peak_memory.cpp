#include "reference_fem/distributed/peak_memory.hpp"

#include <sys/resource.h>

namespace reference_fem {

double peak_memory_mb()
{
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

}  // namespace reference_fem

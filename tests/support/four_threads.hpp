// Four threads for the tests of a program, also where there are fewer processors: by default, oneTBB uses no more
// threads than these.
#pragma once

#ifdef PBS_WITH_THREADS
#include <tbb/global_control.h>

namespace test_support {

inline const tbb::global_control four_threads(tbb::global_control::max_allowed_parallelism, 4);

}  // namespace test_support
#endif

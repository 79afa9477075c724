// Independent tasks on several threads (oneTBB), or one after the other where threads = 1 or the build has none.
#pragma once

#include <functional>

namespace pbs {

// task(0) .. task(count - 1), in any order, on at most so many threads.
void parallel_for(int count, int threads, const std::function<void(int)>& task);

bool built_with_threads();

}  // namespace pbs

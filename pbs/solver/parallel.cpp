#include "pbs/solver/parallel.hpp"

#ifdef PBS_WITH_THREADS
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#endif

namespace pbs {

void parallel_for(int count, int threads, const std::function<void(int)>& task)
{
#ifdef PBS_WITH_THREADS
    if (threads > 1 && count > 1) {
        tbb::task_arena arena(threads);
        arena.execute([&] { tbb::parallel_for(0, count, task, tbb::static_partitioner()); });
        return;
    }
#endif
    static_cast<void>(threads);
    for (int i = 0; i < count; ++i) task(i);
}

bool built_with_threads()
{
#ifdef PBS_WITH_THREADS
    return true;
#else
    return false;
#endif
}

}  // namespace pbs

#include "pbs/packed/parallel.hpp"

#include <algorithm>

#ifdef PBS_TELL_THREAD_SANITIZER
#include <sanitizer/tsan_interface.h>
#endif
#ifdef PBS_WITH_THREADS
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#endif

namespace pbs {

#ifdef PBS_WITH_THREADS
namespace {

// Report to the thread sanitizer what threads hand to each other through oneTBB, since it cannot see into a library built without it. It
// still finds two tasks that touch the same place. In every other build they are nothing.
void give([[maybe_unused]] void* place)
{
#ifdef PBS_TELL_THREAD_SANITIZER
    __tsan_release(place);
#endif
}

void take([[maybe_unused]] void* place)
{
#ifdef PBS_TELL_THREAD_SANITIZER
    __tsan_acquire(place);
#endif
}

}  // namespace

class Parallel::Arena {
public:
    explicit Arena(int threads) : arena_(std::min(threads, allowed())) {}

    void for_each(int count, const std::function<void(int)>& task)
    {
        char start = 0, end = 0;  // places that the caller and the tasks hand to each other
        give(&start);
        arena_.execute([&] {
            tbb::parallel_for(
                tbb::blocked_range<int>(0, count, 1),
                [&](const auto& range) {
                    take(&start);
                    for (int i = range.begin(); i < range.end(); ++i) task(i);
                    give(&end);
                },
                tbb::simple_partitioner());
        });
        take(&end);
    }

private:
    static int allowed() { return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism)); }

    tbb::task_arena arena_;
};
#else
class Parallel::Arena {
public:
    explicit Arena(int) {}

    void for_each(int count, const std::function<void(int)>& task)
    {
        for (int i = 0; i < count; ++i) task(i);
    }
};
#endif

Parallel::Parallel(int threads) : arena_(threads > 1 ? std::make_unique<Arena>(threads) : nullptr)
{
}

Parallel::~Parallel() = default;
Parallel::Parallel(Parallel&&) noexcept = default;
Parallel& Parallel::operator=(Parallel&&) noexcept = default;

void Parallel::for_each(int count, const std::function<void(int)>& task) const
{
    if (arena_ && count > 1) return arena_->for_each(count, task);
    for (int i = 0; i < count; ++i) task(i);
}

void Parallel::for_each_slab(int slabs, const std::function<void(int)>& task) const
{
    for (const int parity : {0, 1}) for_each((slabs + 1 - parity) / 2, [&](int pair) { task(2 * pair + parity); });
}

}  // namespace pbs

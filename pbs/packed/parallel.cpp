#include "pbs/packed/parallel.hpp"

#include "pbs/system/deferred_sigterm.hpp"

#include <algorithm>
#include <utility>

#ifdef PBS_TELL_THREAD_SANITIZER
#include <sanitizer/tsan_interface.h>
#endif
#ifdef PBS_WITH_THREADS
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/task_scheduler_observer.h>
#endif

namespace pbs {

#ifdef PBS_WITH_THREADS
namespace {

// Report to the thread sanitizer what threads hand to each other through oneTBB, since it cannot see into a library
// built without it. It still finds two tasks that touch the same place. In every other build they are nothing.
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

// Workers take no SIGTERM, so that none of them runs METIS's handler.
class Workers : public tbb::task_scheduler_observer {
public:
    explicit Workers(tbb::task_arena& arena) : task_scheduler_observer(arena) { observe(true); }
    ~Workers() override { observe(false); }
    Workers(const Workers&) = delete;
    Workers& operator=(const Workers&) = delete;

    void on_scheduler_entry(bool is_worker) override
    {
        thread_local bool is_blocked = false;
        if (is_worker && !std::exchange(is_blocked, true)) block_sigterm();
    }
};

}  // namespace

class Parallel::Arena {
public:
    explicit Arena(int threads) : arena_(std::min(threads, allowed())), workers_(arena_) {}

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
    static int allowed()
    {
        return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
    }

    tbb::task_arena arena_;
    Workers workers_;
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

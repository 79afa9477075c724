#include "pbs/packed/parallel.hpp"

#include "pbs/packed/parallel.cpp"

#include <algorithm>

#ifdef PBS_WITH_THREADS
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#endif

namespace pbs {

#ifdef PBS_WITH_THREADS
class Parallel::Arena {
public:
    explicit Arena(int threads) : arena_(std::min(threads, allowed())) {}

    void for_each(int count, const std::function<void(int)>& task)
    {
        HandOver call;
        arena_.execute([&] {
            tbb::parallel_for(
                tbb::blocked_range<int>(0, count, 1),
                [&](const auto& range) {
                    const HandOver::Task handed(call);
                    for (int i = range.begin(); i < range.end(); ++i) task(i);
                },
                tbb::simple_partitioner());
        });
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

}  // namespace pbs

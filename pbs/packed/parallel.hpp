// Independent tasks on several threads (oneTBB), or one after the other where there is one thread or the build has
// none.
//   const Parallel parallel(threads);
//   parallel.for_each(slabs, [&](int slab) { ... });
#pragma once

#include <functional>
#include <memory>

namespace pbs {

// A number of threads to share tasks among; moved, not copied.
class Parallel {
public:
    // at most this many threads, including the caller's, and no more than oneTBB allows in this process
    explicit Parallel(int threads);
    ~Parallel();
    Parallel(Parallel&&) noexcept;             // the other is then for one thread
    Parallel& operator=(Parallel&&) noexcept;  // likewise

    // task(0) .. task(count - 1), in any order; returns when all are done.
    void for_each(int count, const std::function<void(int)>& task) const;
    // The same for slabs that touch the next one alone (vertex_order.hpp): all even ones, then all odd ones.
    void for_each_slab(int slabs, const std::function<void(int)>& task) const;

private:
    class Arena;  // threads that stay near from one call to the next
    std::unique_ptr<Arena> arena_;
};

}  // namespace pbs

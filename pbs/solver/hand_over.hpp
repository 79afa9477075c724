// Reports to the thread sanitizer what threads hand to each other through oneTBB, since it cannot see into a library built without it.
//   HandOver call;                   // what the caller wrote before ...
//   { HandOver::Task task(call); }   // ... each task may read; what the tasks wrote, the caller may read when `call` has ended
// It still finds two tasks that touch the same place. In every other build these are nothing.
#pragma once

#ifdef PBS_TELL_THREAD_SANITIZER
#include <sanitizer/tsan_interface.h>
#endif

namespace pbs {

// One call that hands tasks to other threads, and takes them back when it ends.
class HandOver {
public:
    HandOver() { give(start_); }
    ~HandOver() { take(end_); }
    HandOver(const HandOver&) = delete;
    HandOver& operator=(const HandOver&) = delete;

    // One of its tasks, on whichever thread.
    class Task {
    public:
        // After this the task may read what the caller wrote.
        explicit Task(HandOver& call) : call_(call) { take(call_.start_); }
        ~Task() { give(call_.end_); }
        Task(const Task&) = delete;
        Task& operator=(const Task&) = delete;

    private:
        HandOver& call_;
    };

private:
    struct Place {};
#ifdef PBS_TELL_THREAD_SANITIZER
    static void give(Place& place)
    {
        __tsan_release(&place);
    }
    static void take(Place& place)
    {
        __tsan_acquire(&place);
    }
#else
    static void give(Place&)
    {
    }
    static void take(Place&)
    {
    }
#endif

    Place start_, end_;
};

}  // namespace pbs

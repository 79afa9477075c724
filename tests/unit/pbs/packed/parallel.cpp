// Reference: the definition. Every task runs once, and an exception of a task reaches the caller.
#include "pbs/packed/parallel.hpp"
#include "tests/support/four_threads.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace {

class ParallelTasks : public testing::TestWithParam<int> {
protected:
    const pbs::Parallel parallel_{GetParam()};
};

std::string threads(const testing::TestParamInfo<int>& info)
{
    return std::to_string(info.param) + "_threads";
}
INSTANTIATE_TEST_SUITE_P(On, ParallelTasks, testing::Values(1, 2, 4), threads);

std::vector<int> runs_of_each(const pbs::Parallel& parallel, int count)
{
    std::vector<std::atomic<int>> runs(count);
    parallel.for_each(count, [&](int task) { ++runs.at(task); });
    return {runs.begin(), runs.end()};
}

TEST_P(ParallelTasks, EachOnce)
{
    for (const int count : {0, 1, 2, 3, 4, 5, 1000})
        EXPECT_EQ(runs_of_each(parallel_, count), std::vector<int>(count, 1)) << count << " tasks";
}

// When the call returns, the caller can read what the tasks have written.
TEST_P(ParallelTasks, AreDoneOnReturn)
{
    for (int call = 0; call < 100; ++call) {
        std::vector<int> written(64, 0);
        parallel_.for_each(64, [&](int task) { written[task] = call + task; });
        for (int task = 0; task < 64; ++task) ASSERT_EQ(written[task], call + task);
    }
}

TEST_P(ParallelTasks, WhatOneThrowsReachesTheCallerAndTheNextOnesRun)
{
    for (const int count : {1, 2, 100})
        for (const int thrower : {0, count - 1}) {
            const auto task = [&](int i) {
                if (i == thrower) throw std::runtime_error("task " + std::to_string(i));
            };
            try {
                parallel_.for_each(count, task);
                ADD_FAILURE() << "nothing reached the caller";
            } catch (const std::runtime_error& error) {
                EXPECT_EQ(error.what(), "task " + std::to_string(thrower));
            }
        }
    EXPECT_THROW(parallel_.for_each(10, [](int) { throw std::runtime_error("sick"); }), std::runtime_error);
    EXPECT_EQ(runs_of_each(parallel_, 10), std::vector<int>(10, 1));
}

// A task of the caller's thread waits until a worker has taken one, however busy the machine is. That thread goes on
// taking the signal.
TEST_P(ParallelTasks, AreSharedWithWorkersThatTakeNoSigterm)
{
    const std::thread::id caller = std::this_thread::get_id();
    std::atomic<int> by_workers = 0, differ = 0;
    const auto latest = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    parallel_.for_each(64, [&](int) {
        const bool is_worker = std::this_thread::get_id() != caller;
        sigset_t blocked;
        pthread_sigmask(SIG_BLOCK, nullptr, &blocked);
        by_workers += is_worker;
        differ += is_worker != (sigismember(&blocked, SIGTERM) == 1);
#ifdef PBS_WITH_THREADS
        while (GetParam() > 1 && by_workers == 0 && std::chrono::steady_clock::now() < latest)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
#endif
    });
    EXPECT_EQ(differ, 0);
#ifdef PBS_WITH_THREADS
    EXPECT_EQ(by_workers > 0, GetParam() > 1);
#endif
}

TEST_P(ParallelTasks, MovedStillRun)
{
    pbs::Parallel from(GetParam());
    const pbs::Parallel to = std::move(from);
    EXPECT_EQ(runs_of_each(to, 10), std::vector<int>(10, 1));
}

}  // namespace

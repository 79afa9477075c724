// Work in several processes at once: results are returned, and a worker's failure or death does not affect the others.
#include "experiments/process/child_process.hpp"

#include "pbs/geometry/input_error.hpp"

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>

namespace {

using experiments::PooledWork;
using experiments::run_in_pool;

TEST(WorkerPool, FinishesEverythingInTheOrderAsked)
{
    const auto folder = std::filesystem::temp_directory_path() / ("worker_pool_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    std::vector<PooledWork> work;
    for (int i = 0; i < 5; ++i)
        work.push_back({"work " + std::to_string(i), 1.0 * i, [folder, i] {
                            std::ofstream(folder / std::to_string(i)) << i;
                            return "";
                        }});
    const auto results = run_in_pool(work, 2);
    ASSERT_EQ(results.size(), 5u);
    for (int i = 0; i < 5; ++i) {
        EXPECT_EQ(results[i].name, "work " + std::to_string(i));
        EXPECT_TRUE(results[i].finished);
        EXPECT_TRUE(std::filesystem::exists(folder / std::to_string(i)));
    }
    std::filesystem::remove_all(folder);
}

TEST(WorkerPool, AnExceptionIsReportedWithItsWords)
{
    const auto results = run_in_pool(
        {{"bad", 1.0, []() -> std::string { throw std::runtime_error("the mesh is empty"); }}, {"good", 1.0, [] { return ""; }}}, 2);
    EXPECT_FALSE(results[0].finished);
    EXPECT_EQ(results[0].failure, "internal error: the mesh is empty; please report it with the command line");
    EXPECT_TRUE(results[1].finished);
}

TEST(WorkerPool, WhatIsThrownNeedBeNoException)
{
    const auto results = run_in_pool({{"bad", 1.0, []() -> std::string { throw std::string("Unknown mesh format"); }}}, 1);
    EXPECT_FALSE(results[0].finished);
    EXPECT_NE(results[0].failure.find("internal error"), std::string::npos) << results[0].failure;
}

// Texts that exceed the capacity of a pipe, from both workers at once.
TEST(WorkerPool, WordsOfAnyLengthArrive)
{
    const std::string words(300'000, 'x');
    const auto results = run_in_pool({{"one", 1.0, [&] { return words; }}, {"other", 1.0, [&] { return words + "y"; }}}, 2);
    EXPECT_EQ(results[0].breakdown, words);
    EXPECT_EQ(results[1].breakdown, words + "y");
}

TEST(WorkerPool, RefusedInputIsToldFromOtherFailures)
{
    const auto results = run_in_pool({{"full", 1.0, []() -> std::string { throw pbs::InputError("metrics.csv", 0, "", "", "no space"); }},
                                      {"bad", 1.0, []() -> std::string { throw std::runtime_error("no"); }}},
                                     2);
    EXPECT_TRUE(results[0].refused);
    EXPECT_EQ(results[0].failure, "metrics.csv: no space");
    EXPECT_FALSE(results[1].refused);
}

// The process that owns the pool is killed. Its worker, which reports its number and would sleep for a minute, ends too.
TEST(WorkerPool, WorkersEndWithTheirParent)
{
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    const pid_t owner = fork();
    if (owner == 0) {
        run_in_pool({{"sleeper", 1.0,
                      [&] {
                          const pid_t self = getpid();
                          return write(ends[1], &self, sizeof self) == sizeof self && sleep(60) == 0 ? "" : "not asleep";
                      }}},
                    1);
        _exit(0);
    }
    pid_t worker = 0;
    ASSERT_EQ(read(ends[0], &worker, sizeof worker), static_cast<ssize_t>(sizeof worker));
    kill(owner, SIGKILL);
    waitpid(owner, nullptr, 0);
    close(ends[1]);
    pollfd end{ends[0], POLLIN, 0};
    EXPECT_EQ(poll(&end, 1, 10'000), 1) << "the worker goes on";  // the pipe ends with the last process that could write
    if (!end.revents) kill(worker, SIGKILL);
    close(ends[0]);
}

TEST(WorkerPool, AKilledWorkerIsReportedByItsSignal)
{
    const auto results = run_in_pool({{"killed", 1.0, []() -> std::string { return std::raise(SIGKILL) == 0 ? "" : "not raised"; }}}, 1);
    EXPECT_FALSE(results[0].finished);
    EXPECT_EQ(results[0].failure, "ended by signal 9");
}

TEST(WorkerPool, ABreakdownIsFinishedAndSaid)
{
    const auto results = run_in_pool({{"broken", 1.0, [] { return "pbs is not finite in frame 3"; }}}, 1);
    EXPECT_TRUE(results[0].finished);
    EXPECT_EQ(results[0].breakdown, "pbs is not finite in frame 3");
    EXPECT_EQ(results[0].failure, "");
}

TEST(WorkerPool, NoWorkIsNoResult)
{
    EXPECT_TRUE(run_in_pool({}, 4).empty());
}

}  // namespace

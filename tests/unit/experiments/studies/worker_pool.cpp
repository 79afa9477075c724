// Work side by side in processes: results come back, and a worker's failure or death stays its own.
#include "experiments/studies/worker_pool.hpp"

#include <gtest/gtest.h>

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
    EXPECT_EQ(results[0].failure, "the mesh is empty");
    EXPECT_TRUE(results[1].finished);
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

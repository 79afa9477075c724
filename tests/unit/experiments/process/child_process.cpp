// Work in a separate process. Reference: the contract of the header.

#include "experiments/process/child_process.hpp"
#include "pbs/geometry/input_error.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <string>

namespace {

using namespace experiments;

TEST(OwnProcess, TellsItsResultHoweverLongAndLeavesNothingBehind)
{
    EXPECT_EQ(in_own_process([] { return nlohmann::json{{"frames", 3}}; }).at("frames"), 3);
    const std::string more_than_a_pipe_holds(300'000, 'x');
    EXPECT_EQ(in_own_process([&] { return nlohmann::json(more_than_a_pipe_holds); }).get<std::string>(),
              more_than_a_pipe_holds);
    int mine = 1;
    in_own_process([&] { return nlohmann::json(++mine); });
    EXPECT_EQ(mine, 1);
}

template <typename Exception>
std::string words_of(const std::function<nlohmann::json()>& work)
{
    try {
        in_own_process(work);
    } catch (const Exception& error) {
        return error.what();
    }
    return "accepted";
}

TEST(OwnProcess, AFailureOrADeathIsToldWithItsWordsAndItsKind)
{
    EXPECT_EQ(words_of<pbs::InputError>(
                  []() -> nlohmann::json { throw pbs::InputError("a.bvh", 0, "", "", "no such clip"); }),
              "a.bvh: no such clip");
    const auto internal = []() -> nlohmann::json { throw std::out_of_range("no such row"); };
    EXPECT_EQ(words_of<std::runtime_error>(internal), "no such row");
    EXPECT_THROW(words_of<pbs::InputError>(internal), std::runtime_error);
    EXPECT_THROW(in_own_process([]() -> nlohmann::json { throw std::string("not an exception"); }), std::runtime_error);
    // Words that are not UTF-8 arrive.
    EXPECT_EQ(in_own_process([] { return nlohmann::json("li\xffmb"); }), "li\xef\xbf\xbdmb");
    EXPECT_EQ(words_of<pbs::InputError>(
                  []() -> nlohmann::json { throw pbs::InputError("li\xffmb", 0, "", "", "cannot be read"); }),
              "li\\xffmb: cannot be read");
    EXPECT_EQ(words_of<pbs::InputError>([] { return nlohmann::json(std::raise(SIGKILL)); }),
              "process = signal 9: expected to end by itself");
}

// Whether a program can be started is known before it is. Reference: execvp of POSIX, which seeks names without a slash
// on the PATH.

TEST(ProgramRun, KnowsWhetherAProgramCanBeStarted)
{
    const test_support::ScratchFolder folder;
    const std::string program = folder.file("program", "#!/bin/sh\n");
    EXPECT_EQ(why_not_startable("sh"), "");
    EXPECT_EQ(why_not_startable("/bin/sh"), "");
    EXPECT_EQ(why_not_startable(program), "Permission denied");
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    EXPECT_EQ(why_not_startable(program), "");
    EXPECT_EQ(why_not_startable(folder.path().string()), "No such file or directory") << "a folder";
    EXPECT_EQ(why_not_startable("no_such_program"), "No such file or directory");
    EXPECT_EQ(why_not_startable(""), "No such file or directory");
}

// It is sought after the change to the folder of its run.
TEST(ProgramRun, DoesNotFindProgramsFromTheCurrentFolder)
{
    namespace fs = std::filesystem;
    const test_support::ScratchFolder folder, exchange;
    const std::string program = folder.file("own_program", "#!/bin/sh\n"), missing = "No such file or directory";
    fs::permissions(program, fs::perms::owner_all);
    fs::create_directory(folder.path() / "bin");
    fs::copy(program, folder.path() / "bin");
    const fs::path before = fs::current_path();
    const std::string folders = std::getenv("PATH");
    fs::current_path(folder.path());
    for (const char* word : {"./own_program", "bin/own_program"}) {
        EXPECT_EQ(why_not_startable(word), missing);
        EXPECT_FALSE(run_program({word}, exchange.path().string()).started);
    }
    for (const std::string entry : {".", "", "bin"}) {
        setenv("PATH", ("/nowhere:" + entry + ":/also_nowhere").c_str(), 1);
        EXPECT_EQ(why_not_startable("own_program"), missing) << entry;
    }
    setenv("PATH", folder.path().c_str(), 1);
    EXPECT_EQ(why_not_startable("own_program"), "");
    EXPECT_TRUE(run_program({"own_program"}, exchange.path().string()).succeeded());
    setenv("PATH", folders.c_str(), 1);
    fs::current_path(before);
}

// Work in several processes at once: results are returned, and a worker's failure or death does not affect the others.

TEST(WorkerPool, FinishesEverythingInTheOrderAsked)
{
    const test_support::ScratchFolder scratch;
    const std::filesystem::path folder = scratch.path();
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
}

// One worker of each kind, side by side: the end of one does not affect the others.
TEST(WorkerPool, EachEndIsReported)
{
    const struct {
        const char* name;
        std::function<std::string()> action;
        bool is_finished, is_refused;
        const char *breakdown, *failure;
    } ends[] = {
        {"good", [] { return ""; }, true, false, "", ""},
        {"broken", [] { return "pbs is not finite in frame 3"; }, true, false, "pbs is not finite in frame 3", ""},
        {"bad", []() -> std::string { throw std::runtime_error("the mesh is empty"); }, false, false, "",
         "internal error: the mesh is empty; please report it with the command line"},
        {"no exception", []() -> std::string { throw std::string("Unknown mesh format"); }, false, false, "",
         "internal error: an exception without a message; please report it with the command line"},
        {"refused", []() -> std::string { throw pbs::InputError("metrics.csv", 0, "", "", "no space"); }, false, true,
         "", "metrics.csv: no space"},
        {"killed", []() -> std::string { return std::raise(SIGKILL) == 0 ? "" : "not raised"; }, false, false, "",
         "ended by signal 9"},
    };
    std::vector<PooledWork> work;
    for (const auto& end : ends) work.push_back({end.name, 1.0, end.action});
    const auto results = run_in_pool(work, 2);
    for (std::size_t i = 0; i < work.size(); ++i) {
        SCOPED_TRACE(ends[i].name);
        EXPECT_EQ(results[i].finished, ends[i].is_finished);
        EXPECT_EQ(results[i].refused, ends[i].is_refused);
        EXPECT_EQ(results[i].breakdown, ends[i].breakdown);
        EXPECT_EQ(results[i].failure, ends[i].failure);
    }
}

// Texts that exceed the capacity of a pipe, from both workers at once.
TEST(WorkerPool, WordsOfAnyLengthArriveAndNoneOfNoWork)
{
    const std::string words(300'000, 'x');
    const auto results =
        run_in_pool({{"one", 1.0, [&] { return words; }}, {"other", 1.0, [&] { return words + "y"; }}}, 2);
    EXPECT_EQ(results[0].breakdown, words);
    EXPECT_EQ(results[1].breakdown, words + "y");
    EXPECT_TRUE(run_in_pool({}, 4).empty()) << "no work is no result";
}

// The process that owns the pool is killed. Its worker, which reports its number and would sleep for a minute, ends
// too.
TEST(WorkerPool, WorkersEndWithTheirParent)
{
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    const pid_t owner = fork();
    if (owner == 0) {
        run_in_pool({{"sleeper", 1.0,
                      [&] {
                          const pid_t self = getpid();
                          return write(ends[1], &self, sizeof self) == sizeof self && sleep(60) == 0 ? ""
                                                                                                     : "not asleep";
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
    // the pipe ends with the last process that could write
    EXPECT_EQ(poll(&end, 1, 10'000), 1) << "the worker goes on";
    if (!end.revents) kill(worker, SIGKILL);
    close(ends[0]);
}

}  // namespace

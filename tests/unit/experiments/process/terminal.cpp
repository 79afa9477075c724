// Failures, interruption, colours and width. References: the contract of exit statuses
// (experiments/command_line/README.md), and the conventions of no-color.org and CLICOLOR_FORCE; a test's standard
// output is not a terminal.

#include "analysis/records/record_files.hpp"
#include "experiments/process/child_process.hpp"
#include "experiments/process/terminal.hpp"
#include "pbs/geometry/cost.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/system/child_process.hpp"
#include "pbs/system/files.hpp"
#include "tests/support/scratch_folder.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace experiments;

template <typename Exception>
Failure failure_of(const Exception& exception)
{
    try {
        throw exception;
    } catch (...) {
        return caught_failure();
    }
}

// Bad input keeps its words, a place on disk is named with the system's reason, and what nobody has foreseen is no bad
// input.
TEST(Failure, HasTheWordsAndTheStatusOfItsKind)
{
    const auto report = [](const std::string& words) {
        return "internal error: " + words + "; please report it with the command line";
    };
    const std::filesystem::filesystem_error disk("cannot remove", "out/run.json",
                                                 std::make_error_code(std::errc::read_only_file_system));
    const struct {
        Failure failure;
        std::string message;
        ExitStatus status;
    } rows[] = {
        {failure_of(pbs::InputError("limb.toml", 12, "pbs.k_volume", "1.4", "expected 0 <= k <= 1")),
         "limb.toml:12: pbs.k_volume = 1.4: expected 0 <= k <= 1", exit_input},
        {failure_of(disk), "out/run.json: Read-only file system", exit_input},
        {failure_of(std::bad_alloc()), "not enough memory for this task", exit_input},
        {failure_of(Interrupted{}), "interrupted; what was finished is kept", exit_interrupted},
        {failure_of(std::out_of_range("basic_string::substr")), report("basic_string::substr"), exit_internal},
        {failure_of(std::runtime_error("\n----\nAn error\n\n  occurred")), report("---- An error occurred"),
         exit_internal},
        {failure_of(std::string("basic_string::substr")), report("an exception without a message"), exit_internal}};
    for (const auto& [failure, message, status] : rows) {
        EXPECT_EQ(failure.message(), message);
        EXPECT_EQ(failure.status, status) << message;
    }
}

// The exit status of a process that watches interrupts, and the seconds that it took.
std::pair<int, double> end_of(const std::function<void()>& work)
{
    const pbs::Stopwatch stopwatch;
    const pid_t child = fork();
    if (child == 0) {
        dup2(open("/dev/null", O_WRONLY), STDERR_FILENO);
        watch_interrupts();
        try {
            work();
        } catch (...) {
            _exit(10 + caught_failure().status);
        }
        _exit(exit_finished);
    }
    int status = 0;
    waitpid(child, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status), stopwatch.seconds()};
}

// Reference: the contract in the header. Without the watch, the signal itself would end the process.
TEST(Interruption, EndsTheProgramAtOnceAndRemovesItsUnfinishedFiles)
{
    const test_support::ScratchFolder folder;
    for (const int signal : {SIGINT, SIGTERM}) {
        const auto [status, seconds] = end_of([&] {
            pbs::AtomicFile first(folder / "first.csv"), second(folder / "second.csv"),
                finished(folder / "finished.csv");
            finished.finish();
            const pbs::Stage outer("a model"), inner("a library that never ends");
            std::raise(signal);
            for (;;) pause();
        });
        EXPECT_EQ(status, exit_interrupted);
        EXPECT_LT(seconds, 2.0);
        EXPECT_EQ(analysis::files_in(folder.path()), std::vector<std::filesystem::path>{folder / "finished.csv"});
    }
}

TEST(Interruption, IsOnlyNotedByWorkThatLooksForItUntilTheNextSignal)
{
    EXPECT_EQ(end_of([] {
                  const NotedInterrupts noted;
                  std::raise(SIGTERM);
                  if (!interrupted()) _exit(exit_internal);
                  stop_if_interrupted();
              }).first,
              10 + exit_interrupted);
    EXPECT_EQ(end_of([] {
                  const NotedInterrupts around;
                  {
                      const NotedInterrupts noted;
                      raise(SIGINT);
                  }
                  if (!take_interruption() || interrupted()) _exit(exit_internal);
                  raise(SIGTERM);
                  _exit(exit_bound);  // the second signal was noted too
              }).first,
              exit_interrupted);
    EXPECT_EQ(end_of([] {
                  std::optional<NotedInterrupts> noted(std::in_place);
                  noted.reset();
                  raise(SIGINT);
              }).first,
              exit_interrupted);
}

// A signal to all processes of a group reaches a worker twice: directly, and from its parent.
TEST(Interruption, OfASecondSignalEndsTheProgramAndNoWorkerThatNotesIt)
{
    const auto work = [] {
        const NotedInterrupts noted;
        raise(SIGTERM);
        raise(SIGINT);
        return nlohmann::json(interrupted());
    };
    EXPECT_EQ(end_of([&] {
                  if (in_own_process(work) == nlohmann::json(true)) _exit(exit_bound);
              }).first,
              exit_bound);
}

// A worker's temporary files go with it, also where its parent is killed. The pipe ends with the last process that
// could write.
TEST(Interruption, EndsTheChildrenOfTheProgramWhichRemoveTheirFiles)
{
    const test_support::ScratchFolder folder;
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    const auto work = [&] {
        const pbs::AtomicFile file(folder / "unfinished.csv");
        const ssize_t written = write(ends[1], "x", 1);
        return nlohmann::json(written + sleep(60));
    };
    for (const int signal : {SIGINT, SIGTERM, SIGKILL}) {
        const pid_t program = fork();
        if (program == 0) {
            dup2(open("/dev/null", O_WRONLY), STDERR_FILENO);
            watch_interrupts();
            try {
                in_own_process(work);
            } catch (const Interrupted&) {
                _exit(exit_interrupted);
            }
            _exit(exit_internal);
        }
        char begun = 0;
        ASSERT_EQ(read(ends[0], &begun, 1), 1);
        kill(program, signal);
        int status = 0;
        waitpid(program, &status, 0);
        EXPECT_EQ(WIFEXITED(status) ? WEXITSTATUS(status) : WTERMSIG(status),
                  signal == SIGKILL ? SIGKILL : exit_interrupted);
        const pbs::Stopwatch stopwatch;
        while (!analysis::files_in(folder.path()).empty() && stopwatch.seconds() < 10.0) usleep(1'000);
        EXPECT_TRUE(analysis::files_in(folder.path()).empty()) << "signal " << signal;
    }
    close(ends[0]);
    close(ends[1]);
}

// To stderr, once, by the program alone.
TEST(Stages, ThatTakeLongAreNamed)
{
    const test_support::ScratchFolder folder;
    const std::string file = folder.file("stderr.txt", "");
    const pid_t program = fork();
    if (program == 0) {
        dup2(open(file.c_str(), O_WRONLY), STDERR_FILENO);
        watch_interrupts();
        const pbs::Stage outer("outer"), inner("inner");
        const pbs::Stopwatch stopwatch;
        while (analysis::read_text(file).empty() && stopwatch.seconds() < 10.0) usleep(10'000);
        in_own_process([] { return nlohmann::json((pbs::Stage("of a child"), usleep(1))); });
        _exit(exit_finished);
    }
    waitpid(program, nullptr, 0);
    EXPECT_EQ(analysis::read_text(file), "inner ...\n");
}

class Terminal : public ::testing::Test {
protected:
    void SetUp() override
    {
        for (const char* name : {"NO_COLOR", "CLICOLOR_FORCE", "COLUMNS"}) unsetenv(name);
        kept_ = dup(STDOUT_FILENO);
        dup2(open("/dev/null", O_WRONLY), STDOUT_FILENO);
    }

    void TearDown() override
    {
        dup2(kept_, STDOUT_FILENO);
        close(kept_);
    }

private:
    int kept_ = -1;
};

TEST_F(Terminal, AFileHasNoColoursUnlessTheyAreAskedForAndItsWidthIsThatOfColumnsElseAHundred)
{
    EXPECT_FALSE(terminal_has_colours());
    setenv("CLICOLOR_FORCE", "0", 1);
    EXPECT_FALSE(terminal_has_colours());
    setenv("CLICOLOR_FORCE", "1", 1);
    EXPECT_TRUE(terminal_has_colours());
    setenv("NO_COLOR", "1", 1);
    EXPECT_FALSE(terminal_has_colours()) << "NO_COLOR is stronger";
    EXPECT_EQ(terminal_width(), 100u);
    setenv("COLUMNS", "72", 1);
    EXPECT_EQ(terminal_width(), 72u);
}

// Reference: the warnings that the test gives.
TEST(CollectedWarnings, OfAllProcessesAreInTheFileOnceWithTheirCounts)
{
    const test_support::ScratchFolder folder;
    const std::string file = folder.file("warnings.txt", "of an earlier run\n");
    CollectedWarnings warnings(file);
    EXPECT_FALSE(std::filesystem::exists(file)) << "there is none yet";
    warn({"a.toml: one", "b.toml: two\nlines"});
    const auto warn_again = [] { return warn({"a.toml: one"}), std::string(); };
    run_in_pool({{"one", 1.0, warn_again}, {"other", 1.0, warn_again}}, 2);
    warnings.add("limb: 3 frames");
    EXPECT_EQ(warnings.summary(), "Warnings: 3, in " + file + "\n");
    EXPECT_EQ(analysis::read_text(file),
              "limb: 3 frames\npbskin: warning: a.toml: one (3 times)\npbskin: warning: b.toml: two lines\n");
}

TEST(CollectedWarnings, HaveNoFileWithoutWarningsAndAreSummedUpWhereTheWorkEndsEarly)
{
    const test_support::ScratchFolder folder;
    EXPECT_EQ(CollectedWarnings(folder / "none.txt").summary(), "");
    EXPECT_FALSE(std::filesystem::exists(folder / "none.txt"));
    {
        CollectedWarnings warnings(folder / "early.txt");
        warn({"twice", "twice"});
    }
    EXPECT_EQ(analysis::read_text(folder / "early.txt"), "pbskin: warning: twice (2 times)\n");
    EXPECT_THROW(CollectedWarnings(folder / "no/folder.txt"), pbs::InputError);
}

}  // namespace

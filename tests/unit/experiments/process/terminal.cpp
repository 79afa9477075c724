// Colours and width. Reference: the conventions of no-color.org and CLICOLOR_FORCE; a test's standard output is not a terminal.

#include "experiments/process/terminal.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <new>
#include <stdexcept>

// Reference: the contract of exit statuses (experiments/command_line/README.md).

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

// Bad input keeps its words, a place on disk is named with the system's reason, and what nobody has foreseen is no bad input.
TEST(Failure, HasTheWordsAndTheStatusOfItsKind)
{
    const auto report = [](const std::string& words) { return "internal error: " + words + "; please report it with the command line"; };
    const std::filesystem::filesystem_error disk("cannot remove", "out/run.json", std::make_error_code(std::errc::read_only_file_system));
    const struct {
        Failure failure;
        std::string message;
        ExitStatus status;
    } rows[] = {{failure_of(pbs::InputError("limb.toml", 12, "pbs.k_volume", "1.4", "expected 0 <= k <= 1")),
                 "limb.toml:12: pbs.k_volume = 1.4: expected 0 <= k <= 1", exit_input},
                {failure_of(disk), "out/run.json: Read-only file system", exit_input},
                {failure_of(std::bad_alloc()), "not enough memory for this task", exit_input},
                {failure_of(Interrupted{}), "interrupted; what was finished is kept", exit_interrupted},
                {failure_of(std::out_of_range("basic_string::substr")), report("basic_string::substr"), exit_internal},
                {failure_of(std::runtime_error("\n----\nAn error\n\n  occurred")), report("---- An error occurred"), exit_internal},
                {failure_of(std::string("basic_string::substr")), report("an exception without a message"), exit_internal}};
    for (const auto& [failure, message, status] : rows) {
        EXPECT_EQ(failure.message(), message);
        EXPECT_EQ(failure.status, status) << message;
    }
}

class Terminal : public ::testing::Test {
protected:
    void SetUp() override
    {
        for (const char* name : {"NO_COLOR", "CLICOLOR_FORCE", "COLUMNS"}) unsetenv(name);
        kept_ = dup(STDOUT_FILENO);
        const int nothing = open("/dev/null", O_WRONLY);
        dup2(nothing, STDOUT_FILENO);
        close(nothing);
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
    setenv("CLICOLOR_FORCE", "1", 1);
    EXPECT_TRUE(terminal_has_colours());
    setenv("CLICOLOR_FORCE", "0", 1);
    EXPECT_FALSE(terminal_has_colours());
    setenv("CLICOLOR_FORCE", "1", 1);
    setenv("NO_COLOR", "1", 1);
    EXPECT_FALSE(terminal_has_colours()) << "NO_COLOR is stronger";
    EXPECT_EQ(terminal_width(), 100u);
    setenv("COLUMNS", "72", 1);
    EXPECT_EQ(terminal_width(), 72u);
}

}  // namespace

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

TEST(Failure, BadInputKeepsItsWords)
{
    const Failure failure = failure_of(pbs::InputError("limb.toml", 12, "pbs.k_volume", "1.4", "expected 0 <= k <= 1"));
    EXPECT_EQ(failure.message(), "limb.toml:12: pbs.k_volume = 1.4: expected 0 <= k <= 1");
    EXPECT_EQ(failure.status, exit_input);
}

TEST(Failure, WhatNobodyHasForeseenIsNoBadInput)
{
    for (const Failure& failure :
         {failure_of(std::runtime_error("basic_string::substr")), failure_of(std::string("basic_string::substr"))}) {
        EXPECT_EQ(failure.message().rfind("internal error: ", 0), 0u) << failure.message();
        EXPECT_NE(failure.message().find("please report"), std::string::npos) << failure.message();
        EXPECT_EQ(failure.status, exit_internal);
    }
    EXPECT_EQ(
        failure_of(std::runtime_error("\n----\nAn error\n\n  occurred")).message().rfind("internal error: ---- An error occurred; ", 0),
        0u);
    EXPECT_NE(failure_of(std::out_of_range("basic_string::substr")).message().find("basic_string::substr"), std::string::npos);
}

TEST(Failure, APlaceOnDiskIsNamedWithTheSystemsReason)
{
    const std::filesystem::filesystem_error error("cannot remove", "out/run.json", std::make_error_code(std::errc::read_only_file_system));
    EXPECT_EQ(failure_of(error).words, "out/run.json: Read-only file system");
    EXPECT_EQ(failure_of(error).status, exit_input);
}

TEST(Failure, MemoryAndInterruptionHaveTheirOwn)
{
    EXPECT_EQ(failure_of(std::bad_alloc()).status, exit_input);
    EXPECT_EQ(failure_of(Interrupted{}).status, exit_interrupted);
}

using experiments::terminal_has_colours;
using experiments::terminal_width;

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

TEST_F(Terminal, AFileHasNoColoursUnlessTheyAreAskedFor)
{
    EXPECT_FALSE(terminal_has_colours());
    setenv("CLICOLOR_FORCE", "1", 1);
    EXPECT_TRUE(terminal_has_colours());
    setenv("CLICOLOR_FORCE", "0", 1);
    EXPECT_FALSE(terminal_has_colours());
}

TEST_F(Terminal, NoColorIsStronger)
{
    setenv("CLICOLOR_FORCE", "1", 1);
    setenv("NO_COLOR", "1", 1);
    EXPECT_FALSE(terminal_has_colours());
}

TEST_F(Terminal, WidthIsThatOfColumnsElseAHundred)
{
    EXPECT_EQ(terminal_width(), 100u);
    setenv("COLUMNS", "72", 1);
    EXPECT_EQ(terminal_width(), 72u);
}

}  // namespace

// Colours and width. Reference: the conventions of no-color.org and CLICOLOR_FORCE; a test's standard output is not a terminal.
#include "experiments/process/terminal.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include <fcntl.h>
#include <unistd.h>

namespace {

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

// Whether a program can be started is known before it is. Reference: execvp of POSIX, which seeks names without a slash on the PATH.
#include "experiments/process/program_run.hpp"

#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <filesystem>

namespace {

using namespace experiments;

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

}  // namespace

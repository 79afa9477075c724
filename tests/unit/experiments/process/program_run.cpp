// Whether a program can be started is known before it is. Reference: execvp of POSIX, which seeks names without a slash on the PATH.
#include "experiments/process/child_process.hpp"

#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
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

}  // namespace

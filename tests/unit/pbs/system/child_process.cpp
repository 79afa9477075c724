// Reference: what the child was made to do, and the folders that the header of modules specifies.

#include "pbs/geometry/cost.hpp"
#include "pbs/system/child_process.hpp"
#include "pbs/system/module.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/unit/experiments/characters/expect_input_error.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <string>

namespace {

TEST(ChildProcess, TellsATextThatAPipeDoesNotHoldAndItsStatus)
{
    const std::string text(300'000, 'x');
    pbs::ChildProcess child([&] { return pbs::ChildEnd{text, 7}; });
    while (child.writes()) pbs::listen_to({&child});
    EXPECT_EQ(WEXITSTATUS(child.wait()), 7);
    EXPECT_EQ(child.text(), text);
}

TEST(ChildProcess, IsEndedAndWaitedForByItsDestructor)
{
    const pbs::Stopwatch stopwatch;
    {
        pbs::ChildProcess child([] { return pbs::ChildEnd{"", static_cast<int>(sleep(60))}; });
        pbs::listen_to({&child}, 1);  // in which nothing arrives
        EXPECT_TRUE(child.writes());
    }
    EXPECT_LT(stopwatch.seconds(), 10.0);
    EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1) << "a child was left";
}

// Reference: the state of this process's own children.

TEST(Process, IsGoneOnceItHasEndedThoughNobodyHasAskedHow)
{
    EXPECT_FALSE(pbs::process_is_gone(getpid()));
    for (const pid_t none : {0, -std::numeric_limits<pid_t>::max()}) EXPECT_FALSE(pbs::process_is_gone(none));
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        pause();
        _exit(0);
    }
    EXPECT_FALSE(pbs::process_is_gone(child));
    kill(child, SIGKILL);
    siginfo_t how;
    ASSERT_EQ(waitid(P_PID, child, &how, WEXITED | WNOWAIT), 0);  // it stays a zombie
    EXPECT_TRUE(pbs::process_is_gone(child));
    ASSERT_EQ(waitpid(child, nullptr, 0), child);
    EXPECT_TRUE(pbs::process_is_gone(child));
}

// Reference: the folders that the header specifies for the search for modules.

class Modules : public ::testing::Test {
protected:
    void TearDown() override { unsetenv("PBSKIN_MODULES"); }
};

TEST_F(Modules, AMissingOneSaysWhereItWasLookedFor)
{
    for (const char* words : {"/lib/pbskin", "PBSKIN_MODULES"})
        expect_input_error([] { pbs::load_module("pbskin_no_such_module"); }, "libpbskin_no_such_module.so: ", words);
}

TEST_F(Modules, TheEnvironmentVariableNamesTheOnlyFolder)
{
    setenv("PBSKIN_MODULES", "/no/such/folder", 1);
    expect_input_error([] { pbs::load_module("pbskin_no_such_module"); }, "", "looked in /no/such/folder)");
}

TEST_F(Modules, AFileThatIsNoLibraryIsRefusedInTheLoadersWords)
{
    const test_support::ScratchFolder folder;
    folder.file("libpbskin_text.so", "no library");
    setenv("PBSKIN_MODULES", folder.path().c_str(), 1);
    expect_input_error([] { pbs::load_module("pbskin_text"); }, folder / "libpbskin_text.so", "cannot be loaded");
}

#ifdef PBS_WITH_CHOLMOD
TEST_F(Modules, AreLoadedOnceAndFoundBesideTheExecutable)
{
    const pbs::Module& cholmod = pbs::load_module("pbskin_cholmod");
    EXPECT_EQ(&cholmod, &pbs::load_module("pbskin_cholmod"));
    EXPECT_NE(cholmod.function<void()>("pbskin_cholmod_ordered_factor"), nullptr);
}

TEST_F(Modules, AFunctionThatIsNotThereIsRefusedByName)
{
    expect_input_error([] { pbs::load_module("pbskin_cholmod").function<void()>("pbskin_no_such_function"); }, "",
                       "pbskin_no_such_function");
}
#endif

}  // namespace

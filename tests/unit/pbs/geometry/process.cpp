// Reference: the state of this process's own children.
#include "pbs/geometry/process.hpp"

#include <gtest/gtest.h>

#include <sys/wait.h>

namespace {

TEST(Process, IsGoneOnceItHasEndedThoughNobodyHasAskedHow)
{
    EXPECT_FALSE(pbs::process_is_gone(getpid()));
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

}  // namespace

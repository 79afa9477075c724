// Reference: the contract in the header. A handler that is installed meanwhile stands for that of METIS.
#include "pbs/system/deferred_sigterm.hpp"

#include <gtest/gtest.h>

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <thread>

namespace {

volatile std::sig_atomic_t handled = 0;

TEST(DeferredSigterm, LeavesTheSignalToTheHandlerThatThereWasBefore)
{
    struct sigaction own = {}, before = {}, after = {};
    own.sa_handler = [](int) { handled = handled + 1; };
    own.sa_flags = SA_RESTART;
    sigaction(SIGTERM, &own, &before);
    {
        const pbs::DeferredSigterm deferred;
        std::signal(SIGTERM, [](int) { handled = 100; });
        std::raise(SIGTERM);
        EXPECT_EQ(handled, 0);
    }
    EXPECT_EQ(handled, 1);
    std::raise(SIGTERM);
    EXPECT_EQ(handled, 2) << "no longer deferred";
    sigaction(SIGTERM, &before, &after);
    EXPECT_EQ(after.sa_flags & (SA_RESTART | SA_RESETHAND), SA_RESTART);
}

// A library that never returns; the handler says that it was called in another thread.
TEST(SigtermTakenElsewhere, HandlesTheSignalWhileTheCallingThreadTakesNone)
{
    static std::atomic<std::thread::id> taken_by;
    struct sigaction own = {}, before = {};
    own.sa_handler = [](int) { taken_by = std::this_thread::get_id(); };
    own.sa_flags = SA_RESTART;
    sigaction(SIGTERM, &own, &before);
    {
        const pbs::SigtermTakenElsewhere elsewhere;
        kill(getpid(), SIGTERM);
        while (taken_by.load() == std::thread::id()) std::this_thread::yield();
    }
    EXPECT_NE(taken_by.load(), std::this_thread::get_id());
    sigaction(SIGTERM, &before, nullptr);
}

}  // namespace

// Reference: the contract in the header. A handler that is installed meanwhile stands for that of METIS.
#include "pbs/geometry/deferred_sigterm.hpp"

#include <gtest/gtest.h>

#include <csignal>

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

}  // namespace

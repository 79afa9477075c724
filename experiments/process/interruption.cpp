#include "experiments/process/terminal.hpp"

#include "pbs/geometry/child_process.hpp"

#include <csignal>

namespace experiments {
namespace {

volatile std::sig_atomic_t signalled = 0;

void on_signal(int)
{
    signalled = 1;
}

}  // namespace

void watch_interrupts()
{
    struct sigaction action = {};
    action.sa_handler = on_signal;
    action.sa_flags = SA_RESETHAND;  // the second signal ends the program at once
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    pbs::ask_while_reading(stop_if_interrupted);
    std::signal(SIGXFSZ, SIG_IGN);  // then a file over the limit (ulimit -f) is a write error, as on a full disk
}

bool interrupted()
{
    return signalled != 0;
}

void stop_if_interrupted()
{
    if (interrupted()) throw Interrupted{};
}

}  // namespace experiments

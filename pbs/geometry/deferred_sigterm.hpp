// Keeps SIGTERM from METIS. While METIS 5.1 orders a matrix, its own handler gives up the ordering at a SIGTERM, which the program would
// then not notice. What it puts back afterwards handles a single signal (gk_siguntrap calls signal() with the semantics of System V).
#pragma once

#include <csignal>

namespace pbs {

// While this exists, the calling thread takes no SIGTERM. The signal comes afterwards, to the handler that there was before.
//   const DeferredSigterm deferred;
//   cholmod_analyze(...);
class DeferredSigterm {
public:
    DeferredSigterm()
    {
        sigset_t sigterm;
        sigemptyset(&sigterm);
        sigaddset(&sigterm, SIGTERM);
        pthread_sigmask(SIG_BLOCK, &sigterm, &blocked_before_);
        sigaction(SIGTERM, nullptr, &action_before_);
    }
    ~DeferredSigterm()
    {
        sigaction(SIGTERM, &action_before_, nullptr);
        pthread_sigmask(SIG_SETMASK, &blocked_before_, nullptr);
    }
    DeferredSigterm(const DeferredSigterm&) = delete;
    DeferredSigterm& operator=(const DeferredSigterm&) = delete;

private:
    sigset_t blocked_before_;
    struct sigaction action_before_;
};

}  // namespace pbs

// METIS 5.1 has its own handler of SIGTERM while it orders a matrix or cuts a mesh. At the signal it gives up its work,
// and the program's handler is not called. Afterwards gk_siguntrap puts the program's handler back by signal() with the
// semantics of System V: that handler then handles only one signal, and system calls that it interrupts are not
// restarted.
#pragma once

#include <csignal>
#include <semaphore>
#include <system_error>
#include <thread>

namespace pbs {

inline void mask_sigterm(int how, sigset_t* blocked_before = nullptr)
{
    sigset_t sigterm;
    sigemptyset(&sigterm);
    sigaddset(&sigterm, SIGTERM);
    pthread_sigmask(how, &sigterm, blocked_before);
}

// From now on the calling thread, and threads that it starts, take no SIGTERM.
inline void block_sigterm(sigset_t* blocked_before = nullptr)
{
    mask_sigterm(SIG_BLOCK, blocked_before);
}

// While this exists, the calling thread takes no SIGTERM. A pending one is handled afterwards, by the handler that
// there was before. Threads that are started meanwhile never take it. Other threads must not take it either, since they
// would run METIS's handler: what starts threads (OpenBLAS, deal.II) is called under this guard, and workers of oneTBB
// block the signal. Only one thread at a time may call METIS.
//   const DeferredSigterm deferred;
//   cholmod_analyze(...);
class DeferredSigterm {
public:
    DeferredSigterm()
    {
        block_sigterm(&blocked_before_);
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

// The same for a library that starts threads while it is loaded, except that a thread of this object takes the signal
// at once: the library may never return, as OpenBLAS where its threads find no memory. METIS must not run meanwhile.
//   const SigtermTakenElsewhere elsewhere;
//   dlopen(...);
class SigtermTakenElsewhere {
public:
    SigtermTakenElsewhere()
    {
        try {
            taker_ = std::thread([this] {
                mask_sigterm(SIG_UNBLOCK);
                is_loaded_.acquire();
            });
        } catch (const std::system_error&) {  // too little memory for a thread: the signal waits
        }
    }
    ~SigtermTakenElsewhere()
    {
        is_loaded_.release();
        if (taker_.joinable()) taker_.join();
    }
    SigtermTakenElsewhere(const SigtermTakenElsewhere&) = delete;
    SigtermTakenElsewhere& operator=(const SigtermTakenElsewhere&) = delete;

private:
    const DeferredSigterm deferred_;
    std::binary_semaphore is_loaded_{0};
    std::thread taker_;
};

}  // namespace pbs

// What processes ask of each other.
//   const pid_t parent = getpid();
//   if (fork() == 0) { end_with_parent(parent); ... }   // a child that does not outlive its parent, however that one ends
#pragma once

#include <signal.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <cerrno>

namespace pbs {

// In the child, first of all (prctl(2), PR_SET_PDEATHSIG). The parent's thread that forked must live as long as the child is needed.
inline void end_with_parent(pid_t parent)
{
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(128 + SIGKILL);  // it ended before the line above
}

// No process of this number is on this machine: what it left half-made can be removed.
inline bool process_is_gone(pid_t process)
{
    return ::kill(process, 0) != 0 && errno == ESRCH;
}

}  // namespace pbs

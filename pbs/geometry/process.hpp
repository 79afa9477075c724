// Relations between processes: a child that ends with its parent, and whether a process is still running.
//   const pid_t parent = getpid();
//   if (fork() == 0) { end_with_parent(parent); ... }   // a child that does not outlive its parent, however that one ends
#pragma once

#include <signal.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <string>

namespace pbs {

// Call this first in the child (prctl(2), PR_SET_PDEATHSIG). The parent's thread that forked must live as long as the child is needed.
inline void end_with_parent(pid_t parent)
{
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(128 + SIGKILL);  // it ended before the line above
}

// No process of this number is on this machine: what it left half-made can be removed.
inline bool process_is_gone(pid_t process)
{
    if (::kill(process, 0) != 0 && errno == ESRCH) return true;
    std::string status;  // proc(5): number (name) state ...; Z and X have ended, and nobody has waited for them
    std::getline(std::ifstream("/proc/" + std::to_string(process) + "/stat"), status);
    const std::size_t name_end = status.rfind(") ");
    return name_end != std::string::npos && (status[name_end + 2] == 'Z' || status[name_end + 2] == 'X');
}

}  // namespace pbs

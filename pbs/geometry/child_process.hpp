// Other people's readers on damaged files: assimp ends the process on one damaged .ply in two, VTK and Gmsh on rarer ones, and all three
// may take memory or time without limit. They run in a child process, silent, with a limit on memory, processor time and time; what they
// read comes back through a pipe, and whatever becomes of the child, the caller gets its bytes or an InputError that names the file and
// says how the child died.
//   const std::string bytes = read_isolated("walk.bvh", [](const std::string& path) { return packed(read_by_library(path)); });
// The bytes come from a process that damage may have led astray: check them (packed_bytes.hpp).
#pragma once

#include <signal.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <functional>
#include <string>

namespace pbs {

// Asked several times a second while a reader is waited for; what it throws ends the reader and leaves read_isolated. Once, at the start:
//   ask_while_reading(stop_if_interrupted);
void ask_while_reading(std::function<void()> question);

// read(path) in a child process; its exceptions come back as InputErrors.
std::string read_isolated(const std::string& path, const std::function<std::string(const std::string&)>& read);

// The resources that a process may use to read one file (child_process.hpp): far more than a sound file needs, and no more than half of
// the memory that there is.

// [s] of time, not of processor time: other work may keep the machine busy.
double reading_limit_s(const std::string& path);

// Limits this process from here on: memory, processor time and no core file. Memory is not limited under a sanitizer.
void limit_reading(const std::string& path);

// Relations between processes: a child that ends with its parent, and whether a process is still running.
//   const pid_t parent = getpid();
//   if (fork() == 0) { end_with_parent(parent); ... }   // a child that does not outlive its parent, however that one ends

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

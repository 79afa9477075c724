// Other people's readers on damaged files: assimp ends the process on one damaged .ply in two, VTK on rarer ones, and both may
// take memory or time without limit. A child process tries first, silent, with limits on memory, processor time and time: far more than
// a sound file needs, and no more than half of the memory that there is. Whatever becomes of the child, the caller gets what was read or an
// InputError that names the file and says how the child died.
//   const TetMesh mesh = read_guarded("arm.vtu", read_vtk);
// Also: the stages of long work, a child that ends with its parent, and whether a process is still running.
//   const pid_t parent = getpid();
//   if (fork() == 0) { end_with_parent(parent); ... }   // a child that does not outlive its parent, however that one ends
#pragma once

#include <signal.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <functional>
#include <string>

namespace pbs {

// Asked several times a second while a child tries; what it throws ends the child and leaves try_reading. Once, at the start:
//   ask_while_reading(stop_if_interrupted);
void ask_while_reading(std::function<void()> question);

// read(path) in a child process, of which nothing stays behind; its exceptions come back as InputErrors.
void try_reading(const std::string& path, const std::function<void(const std::string&)>& read);

// read(path) in this process, once it has succeeded in a child.
template <typename Read>
auto read_guarded(const std::string& path, const Read& read)
{
    try_reading(path, [&](const std::string& file) { read(file); });
    return read(path);
}

// A stage of long work. The program prints the name of a stage that takes long, and ends within a second if it is interrupted in one.
//   const Stage stage("wrapping the surface");
// Stages may contain others. Where nobody watches, as in a program of the user's own, a stage does nothing.
struct StageWatcher {
    void (*begin)(const std::string& name) = nullptr;  // may throw; then the stage has not begun
    void (*end)() = nullptr;
};
inline StageWatcher stage_watcher;

class Stage {
public:
    explicit Stage(const std::string& name)
    {
        if (stage_watcher.begin) stage_watcher.begin(name);
    }
    ~Stage()
    {
        if (stage_watcher.end) stage_watcher.end();
    }
    Stage(const Stage&) = delete;
    Stage& operator=(const Stage&) = delete;
};

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

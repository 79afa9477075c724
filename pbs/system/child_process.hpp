// Child processes, and the stages of long work.
#pragma once

#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

namespace pbs {

// The result of a child process: a text of any length, and the exit status.
struct ChildEnd {
    std::string text;
    int status = 0;
};

// A forked process that works for its parent and ends with it: it gets SIGINT when the parent ends, in whatever way.
// The thread that forked must live as long as the child is needed.
//   ChildProcess child([] { return ChildEnd{"text", 0}; });
//   while (child.writes()) listen_to({&child});
//   const int status = child.wait();      // child.text() is whole
class ChildProcess {
public:
    // InputError if the system has no process or pipe left. Programs that either process starts do not inherit the
    // pipe.
    explicit ChildProcess(const std::function<ChildEnd()>& work);
    ~ChildProcess();  // sends SIGINT to a child that has not been waited for, and waits for its end
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    void ask_to_end() const;                    // by SIGINT; does not wait
    bool writes() const { return pipe_ >= 0; }  // false once no process can write any more
    const std::string& text() const { return text_; }
    int wait();  // for the end of the child; returns its status as of waitpid

private:
    friend void listen_to(const std::vector<ChildProcess*>& children, int longest_ms);
    void take_text();

    pid_t process_ = -1;
    int pipe_ = -1;
    std::string text_;
};

// Waits until one of the children that write has written or has ended, or a signal arrives, and takes what has arrived.
// A parent must listen while a child works, for it waits when its pipe is full. longest_ms: of the wait; -1: no limit.
void listen_to(const std::vector<ChildProcess*>& children, int longest_ms = -1);

// A stage of long work. The program prints the name of a stage that takes long.
//   const Stage stage("wrapping the surface");
// Stages may contain others. Where nobody watches, as in a program of the user's own, a stage does nothing.
struct StageWatcher {
    void (*begin)(const std::string& name) = nullptr;
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

// No process of this number is on this machine: what it left half-made can be removed.
inline bool process_is_gone(pid_t process)
{
    if (process <= 0) return false;  // kill(2) takes such a number for a group
    if (::kill(process, 0) != 0 && errno == ESRCH) return true;
    std::string status;  // proc(5): number (name) state ...; Z and X have ended, and nobody has waited for them
    std::getline(std::ifstream("/proc/" + std::to_string(process) + "/stat"), status);
    const std::size_t name_end = status.rfind(") ");
    return name_end != std::string::npos && (status[name_end + 2] == 'Z' || status[name_end + 2] == 'X');
}

}  // namespace pbs

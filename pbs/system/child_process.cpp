#include "pbs/system/child_process.hpp"

#include "pbs/geometry/input_error.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace pbs {
namespace {

[[noreturn]] void refuse_process()
{
    throw InputError("", 0, "process", "", std::string("cannot be started: ") + std::strerror(errno));
}

// Until all is written, signals or not, or nobody reads any more.
void write_whole(int pipe, const std::string& text)
{
    for (std::size_t sent = 0; sent < text.size();) {
        const ssize_t count = ::write(pipe, text.data() + sent, text.size() - sent);
        if (count < 0 && errno != EINTR) return;
        if (count > 0) sent += static_cast<std::size_t>(count);
    }
}

}  // namespace

ChildProcess::ChildProcess(const std::function<ChildEnd()>& work)
{
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) refuse_process();
    std::fflush(nullptr);
    const pid_t parent = getpid();
    process_ = fork();
    if (process_ == 0) {
        struct sigaction inherited = {};
        sigaction(SIGINT, nullptr, &inherited);
        // of a program that a shell has started in the background
        if (inherited.sa_handler == SIG_IGN) signal(SIGINT, SIG_DFL);
        prctl(PR_SET_PDEATHSIG, SIGINT);
        if (getppid() != parent) _exit(128 + SIGINT);  // it ended before the line above
        close(ends[0]);
        try {
            const ChildEnd end = work();
            write_whole(ends[1], end.text);
            std::fflush(nullptr);
            _exit(end.status);
        } catch (...) {  // or the child would go on as a second parent
            _exit(EXIT_FAILURE);
        }
    }
    close(ends[1]);
    pipe_ = ends[0];
    if (process_ > 0) return;
    close(pipe_);
    refuse_process();
}

ChildProcess::~ChildProcess()
{
    if (pipe_ >= 0) close(pipe_);
    if (process_ < 0) return;
    ask_to_end();
    wait();
}

void ChildProcess::ask_to_end() const
{
    if (process_ > 0) kill(process_, SIGINT);
}

int ChildProcess::wait()
{
    int status = 0;
    const pid_t child = std::exchange(process_, -1);
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    return status;
}

void ChildProcess::take_text()
{
    char buffer[4096];
    const ssize_t count = ::read(pipe_, buffer, sizeof buffer);
    if (count > 0)
        text_.append(buffer, static_cast<std::size_t>(count));
    else if (count == 0 || errno != EINTR)
        close(std::exchange(pipe_, -1));
}

void listen_to(const std::vector<ChildProcess*>& children, int longest_ms)
{
    std::vector<pollfd> pipes;
    // poll leaves out those below 0
    for (const ChildProcess* child : children) pipes.push_back({child->pipe_, POLLIN, 0});
    if (poll(pipes.data(), pipes.size(), longest_ms) <= 0) return;
    for (std::size_t i = 0; i < pipes.size(); ++i)
        if (pipes[i].revents != 0) children[i]->take_text();
}

}  // namespace pbs

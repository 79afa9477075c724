#include "experiments/process/child_process.hpp"

#include "experiments/process/terminal.hpp"
#include "pbs/geometry/child_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <stdexcept>
#include <utility>

namespace experiments {
namespace {

// Until all is written, signals or not, or nobody reads any more.
void write_whole(int to, const std::string& text)
{
    for (std::size_t sent = 0; sent < text.size();) {
        const ssize_t count = write(to, text.data() + sent, text.size() - sent);
        if (count < 0 && errno != EINTR) return;
        if (count > 0) sent += static_cast<std::size_t>(count);
    }
}

}  // namespace

ForkedProcess start_process(const std::function<ProcessEnd()>& work)
{
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe for a process");
    fcntl(ends[0], F_SETFL, O_NONBLOCK);
    std::fflush(nullptr);
    const pid_t parent = getpid(), process = fork();
    if (process < 0) throw std::runtime_error("no further process can be started");
    if (process == 0) {
        pbs::end_with_parent(parent);
        close(ends[0]);
        const ProcessEnd end = work();
        write_whole(ends[1], end.text);
        std::fflush(nullptr);
        _exit(end.status);
    }
    close(ends[1]);
    return {process, ends[0]};
}

void listen(ForkedProcess& process)
{
    char buffer[4096];
    while (process.from >= 0) {
        const ssize_t count = read(process.from, buffer, sizeof buffer);
        if (count > 0)
            process.text.append(buffer, static_cast<std::size_t>(count));
        else if (count < 0 && errno == EAGAIN)
            return;
        else if (count == 0 || errno != EINTR)
            close(std::exchange(process.from, -1));
    }
}

void pass_on_interruption(ForkedProcess& process)
{
    if (interrupted() && !std::exchange(process.told_to_stop, true)) kill(process.id, SIGTERM);
}

void wait_for_text(const std::vector<int>& pipes)
{
    constexpr int moment_ms = 20;
    std::vector<pollfd> polled;
    for (const int pipe : pipes) polled.push_back({pipe, POLLIN, 0});  // poll leaves out those below 0
    poll(polled.data(), polled.size(), moment_ms);
}

}  // namespace experiments

#include "experiments/process/process_pipe.hpp"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>

namespace experiments {

ProcessPipe open_process_pipe()
{
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe for a process");
    fcntl(ends[0], F_SETFL, O_NONBLOCK);
    return {ends[0], ends[1]};
}

void write_whole(int to, const std::string& text)
{
    for (std::size_t sent = 0; sent < text.size();) {
        const ssize_t count = write(to, text.data() + sent, text.size() - sent);
        if (count < 0 && errno != EINTR) return;
        if (count > 0) sent += static_cast<std::size_t>(count);
    }
}

bool read_available(int from, std::string& text)
{
    char buffer[4096];
    for (;;) {
        const ssize_t count = read(from, buffer, sizeof buffer);
        if (count > 0)
            text.append(buffer, static_cast<std::size_t>(count));
        else if (count == 0 || errno != EINTR)
            return count < 0 && errno == EAGAIN;
    }
}

void wait_for_words(const std::vector<int>& ends)
{
    constexpr int moment_ms = 20;
    std::vector<pollfd> polled;
    for (const int end : ends) polled.push_back({end, POLLIN, 0});  // poll leaves out those below 0
    poll(polled.data(), polled.size(), moment_ms);
}

}  // namespace experiments

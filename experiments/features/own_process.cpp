#include "experiments/features/own_process.hpp"

#include "experiments/interruption.hpp"
#include "experiments/progress.hpp"
#include "pbs/geometry/process.hpp"
#include "pbs/geometry/input_error.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <stdexcept>
#include <string>

namespace experiments {
namespace {

void write_all(int pipe_end, const std::string& text)
{
    for (std::size_t sent = 0; sent < text.size();) {
        const ssize_t count = write(pipe_end, text.data() + sent, text.size() - sent);
        if (count < 0 && errno != EINTR) return;
        if (count > 0) sent += static_cast<std::size_t>(count);
    }
}

[[noreturn]] void act_and_tell(const std::function<nlohmann::json()>& work, int pipe_end)
{
    nlohmann::json told;
    try {
        told["result"] = work();
    } catch (const std::exception& error) {
        told["failure"] = error.what();
    } catch (const Interrupted&) {
        told["failure"] = "interrupted";
    }
    write_all(pipe_end, told.dump());
    std::fflush(nullptr);
    _exit(0);
}

// Until the other end is closed; an interruption is passed on to the process.
std::string read_all(int pipe_end, pid_t process)
{
    std::string text;
    char buffer[4096];
    for (;;) {
        const ssize_t count = read(pipe_end, buffer, sizeof buffer);
        if (count > 0) text.append(buffer, static_cast<std::size_t>(count));
        if (count == 0) break;
        if (count < 0 && errno != EINTR) break;
        if (interrupted()) kill(process, SIGTERM);
    }
    close(pipe_end);
    return text;
}

}  // namespace

nlohmann::json in_own_process(const std::function<nlohmann::json()>& work)
{
    int ends[2];
    if (pipe(ends) != 0) throw std::runtime_error("no pipe for a process");
    std::fflush(nullptr);
    const pid_t parent = getpid(), process = fork();
    if (process < 0) throw std::runtime_error("no process for a measurement");
    if (process == 0) {
        pbs::end_with_parent(parent);
        close(ends[0]);
        act_and_tell(work, ends[1]);
    }
    close(ends[1]);
    const std::string text = read_all(ends[0], process);
    int status = 0;
    while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
    }
    stop_if_interrupted();
    if (WIFSIGNALED(status))
        throw pbs::InputError("", 0, "process", "signal " + std::to_string(WTERMSIG(status)), "expected to end by itself");
    const nlohmann::json told = nlohmann::json::parse(text, nullptr, false);
    if (!told.is_object() || !told.contains("result"))
        throw pbs::InputError("", 0, "process", told.is_object() ? told.value("failure", "") : "", "expected a result");
    return told.at("result");
}

}  // namespace experiments

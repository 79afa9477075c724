#include "experiments/process/own_process.hpp"

#include "experiments/process/failure.hpp"
#include "experiments/process/interruption.hpp"
#include "experiments/process/process_pipe.hpp"
#include "analysis/records/record_text.hpp"
#include "pbs/geometry/process.hpp"
#include "pbs/geometry/input_error.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <utility>

namespace experiments {
namespace {

[[noreturn]] void act_and_tell(const std::function<nlohmann::json()>& work, int pipe_end)
{
    nlohmann::json told;
    try {
        told["result"] = work();
    } catch (...) {
        const Failure failure = caught_failure();
        told = {{"failure", failure.words}, {"status", failure.status}};
    }
    write_whole(pipe_end, analysis::record_text(told));
    std::fflush(nullptr);
    _exit(0);
}

// Until the other end is closed; an interruption is passed on to the process, once: a second signal would end it in the middle of its work.
std::string read_all(int pipe_end, pid_t process)
{
    std::string text;
    bool told_to_stop = false;
    while (read_available(pipe_end, text)) {
        if (interrupted() && !std::exchange(told_to_stop, true)) kill(process, SIGTERM);
        wait_for_words({pipe_end});
    }
    close(pipe_end);
    return text;
}

nlohmann::json result_in(const std::string& text)
{
    const nlohmann::json told = nlohmann::json::parse(text, nullptr, false);
    if (told.is_object() && told.contains("result")) return told.at("result");
    if (!told.is_object()) throw std::runtime_error("a process without a result");
    if (told.value("status", exit_internal) == exit_input) throw pbs::InputError("", 0, "", "", told.value("failure", ""));
    throw std::runtime_error(told.value("failure", ""));
}

}  // namespace

nlohmann::json in_own_process(const std::function<nlohmann::json()>& work)
{
    const ProcessPipe pipe = open_process_pipe();
    std::fflush(nullptr);
    const pid_t parent = getpid(), process = fork();
    if (process < 0) throw std::runtime_error("no process for a measurement");
    if (process == 0) {
        pbs::end_with_parent(parent);
        close(pipe.from);
        act_and_tell(work, pipe.to);
    }
    close(pipe.to);
    const std::string text = read_all(pipe.from, process);
    int status = 0;
    while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
    }
    stop_if_interrupted();
    if (WIFSIGNALED(status))
        throw pbs::InputError("", 0, "process", "signal " + std::to_string(WTERMSIG(status)), "expected to end by itself");
    return result_in(text);
}

}  // namespace experiments

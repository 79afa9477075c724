#include "experiments/process/child_process.hpp"

#include "analysis/records/record_files.hpp"
#include "experiments/process/terminal.hpp"
#include "pbs/geometry/child_process.hpp"
#include "pbs/geometry/cost.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <poll.h>
#include <spawn.h>
#include <spdlog/spdlog.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <map>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace experiments {
namespace {

struct ProcessEnd {
    std::string text;
    int status = 0;
};

// A forked process that returns a text to its parent, however long the text is. It ends with its parent, however that ends.
//   ForkedProcess process = start_process([] { return ProcessEnd{"text", exit_finished}; });
//   while (process.from >= 0) wait_for_text({process.from}), listen(process);
struct ForkedProcess {
    pid_t id = -1;
    int from = -1;          // the pipe that its text comes from; below 0 when no process can write any more
    std::string text = {};  // as far as it has arrived
    bool told_to_stop = false;
};

// Until all is written, signals or not, or nobody reads any more.
void write_whole(int to, const std::string& text)
{
    for (std::size_t sent = 0; sent < text.size();) {
        const ssize_t count = write(to, text.data() + sent, text.size() - sent);
        if (count < 0 && errno != EINTR) return;
        if (count > 0) sent += static_cast<std::size_t>(count);
    }
}

// std::runtime_error where no process or pipe can be had. Programs that either process starts do not inherit the pipe.
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
        if (interrupted()) _exit(exit_interrupted);  // by a signal that nobody passes on to this process
        close(ends[0]);
        const ProcessEnd end = work();
        write_whole(ends[1], end.text);
        std::fflush(nullptr);
        _exit(end.status);
    }
    close(ends[1]);
    return {process, ends[0]};
}

// Appends what has arrived without waiting. Parents must listen while the process works, for it waits when the pipe is full.
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

// Passes an interruption of this process on, once, to a process that has not been waited for: as SIGINT, since METIS has a handler of its
// own for SIGTERM.
void pass_on_interruption(ForkedProcess& process)
{
    if (interrupted() && !std::exchange(process.told_to_stop, true)) kill(process.id, SIGINT);
}

// Waits until one of the pipes has something to read, but only for a moment, so that a signal before the wait is noticed after it.
// Pipes below 0 are left out.
void wait_for_text(const std::vector<int>& pipes)
{
    constexpr int moment_ms = 20;
    std::vector<pollfd> polled;
    for (const int pipe : pipes) polled.push_back({pipe, POLLIN, 0});  // poll leaves out those below 0
    poll(polled.data(), polled.size(), moment_ms);
}

// Waits for the end of a process, signals or not.
int status_of(pid_t process)
{
    int status = 0;
    while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
    }
    return status;
}

ProcessEnd result_or_failure(const std::function<nlohmann::json()>& work)
{
    nlohmann::json end;
    try {
        end["result"] = work();
    } catch (...) {
        const Failure failure = caught_failure();
        end = {{"failure", failure.words}, {"status", failure.status}};
    }
    return {analysis::record_text(end), exit_finished};
}

nlohmann::json result_in(const std::string& text)
{
    const nlohmann::json end = nlohmann::json::parse(text, nullptr, false);
    if (end.is_object() && end.contains("result")) return end.at("result");
    if (!end.is_object()) throw std::runtime_error("a process ended without a result");
    if (end.value("status", exit_internal) == exit_input) throw pbs::InputError("", 0, "", "", end.value("failure", ""));
    throw std::runtime_error(end.value("failure", ""));
}

std::string end_of(const std::string& text)
{
    constexpr std::size_t most = 400;
    const std::size_t end = text.find_last_not_of(" \t\r\n") + 1;
    return text.substr(end > most ? end - most : 0, std::min(end, most));
}

struct Worker {
    std::size_t work = 0;
    ForkedProcess process;
};

ProcessEnd act_as_worker(const PooledWork& work)
{
    hide_progress();
    try {
        const std::string breakdown = work.action();
        return {breakdown, breakdown.empty() ? exit_finished : exit_breakdown};
    } catch (...) {
        const Failure failure = caught_failure();
        return {failure.message(), failure.status};
    }
}

double seconds_of(const timeval& time)
{
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

PooledResult outcome_of(const PooledWork& work, ForkedProcess& process, int status)
{
    listen(process);
    if (process.from >= 0) close(process.from);  // a process that it started may still hold the other end
    const int exit = WIFEXITED(status) ? WEXITSTATUS(status) : exit_internal;
    const bool finished = exit == exit_finished || exit == exit_breakdown;
    PooledResult result{work.name, finished, exit == exit_breakdown ? process.text : "", finished ? "" : process.text};
    result.refused = exit == exit_input;
    if (WIFSIGNALED(status)) result.failure = fmt::format("ended by signal {}", WTERMSIG(status));
    if (exit == exit_interrupted) result.failure = "interrupted";
    return result;
}

// Returns the process that ended. Each wait is short, for a signal that arrives just before a wait without end would only be noticed when a
// worker ends.
pid_t wait_for_any(std::map<pid_t, Worker>& workers, int& status, rusage& usage)
{
    for (;;) {
        std::vector<int> pipes;
        for (auto& [id, worker] : workers) {
            pass_on_interruption(worker.process);
            listen(worker.process);
            pipes.push_back(worker.process.from);
        }
        const pid_t ended = wait4(-1, &status, WNOHANG, &usage);
        if (ended > 0) return ended;
        if (ended < 0 && errno != EINTR) throw std::runtime_error("the workers are gone");
        wait_for_text(pipes);
    }
}

// Prints a line for each quarter of the expected cost that has ended; --verbose prints one for each run.
class PoolProgress {
public:
    PoolProgress(const std::vector<PooledWork>& work, int jobs) : runs_(work.size()), jobs_(jobs)
    {
        for (const PooledWork& item : work) total_s_ += item.cost_s;
    }

    // then_s: the expected cost of what follows.
    void ended(const PooledWork& item, const PooledResult& result, double then_s)
    {
        done_s_ += item.cost_s;
        ++ended_;
        const double left_s = done_s_ > 0.0 ? stopwatch_.seconds() * (total_s_ - done_s_) / done_s_ : 0.0;
        const double pace = done_s_ > 0.0 ? jobs_ * stopwatch_.seconds() / done_s_ : 1.0;  // seconds per expected second
        const double all_left_min = (left_s + std::min(pace, 4.0) * then_s) / 60.0;
        spdlog::debug("{} {} after {:.0f} s", item.name, result.finished ? "finished" : "failed: " + result.failure, stopwatch_.seconds());
        const int quarter = ended_ == runs_ ? 4 : static_cast<int>(4.0 * done_s_ / std::max(total_s_, 1e-9));
        if (quarter <= std::exchange(quarter_, std::max(quarter, quarter_)) || (runs_ < 8 && ended_ < runs_)) return;
        const std::string left = all_left_min >= 1.0 ? fmt::format(", about {:.0f} min left", all_left_min) : "";
        spdlog::info("{} of {} runs after {:.0f} s{}", ended_, runs_, stopwatch_.seconds(), left);
    }

private:
    std::size_t runs_, ended_ = 0;
    int jobs_, quarter_ = 0;
    double total_s_ = 0.0, done_s_ = 0.0;  // expected cost
    pbs::Stopwatch stopwatch_;
};

}  // namespace

nlohmann::json in_own_process(const std::function<nlohmann::json()>& work)
{
    ForkedProcess process = start_process([&] { return result_or_failure(work); });
    for (listen(process); process.from >= 0; listen(process)) {
        pass_on_interruption(process);
        wait_for_text({process.from});
    }
    const int status = status_of(process.id);
    stop_if_interrupted();
    if (WIFSIGNALED(status))
        throw pbs::InputError("", 0, "process", "signal " + std::to_string(WTERMSIG(status)), "expected to end by itself");
    return result_in(process.text);
}

ProgramRun run_program(const std::vector<std::string>& program_and_arguments, const std::optional<std::string>& folder)
{
    std::vector<std::string> words = program_and_arguments;
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);

    const std::string output = folder ? (std::filesystem::path(*folder) / "output.txt").string() : "";
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    if (folder) {
        posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
        posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
        posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
        posix_spawn_file_actions_addchdir_np(&actions, folder->c_str());
    }
    pid_t child = 0;
    ProgramRun run;
    std::fflush(nullptr);
    const int failure = posix_spawnp(&child, arguments.front(), &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    run.started = failure == 0;
    if (!run.started) {
        run.last_words = std::strerror(failure);
        return run;
    }
    int status = 0;
    bool told_to_stop = false;
    while (waitpid(child, &status, WNOHANG) == 0) {
        if (interrupted() && !std::exchange(told_to_stop, true)) kill(child, SIGTERM);
        wait_for_text({});
    }
    stop_if_interrupted();
    run.status = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    if (!folder) return run;
    run.last_words = end_of(analysis::read_text(output));
    std::filesystem::remove(output);
    return run;
}

std::string why_not_startable(const std::string& program)
{
    namespace fs = std::filesystem;
    std::error_code code;
    const auto why_not = [&](const fs::path& file) -> std::string {
        if (!fs::is_regular_file(file, code)) return std::strerror(ENOENT);
        return access(file.c_str(), X_OK) == 0 ? "" : std::strerror(EACCES);
    };
    std::string why = std::strerror(ENOENT);
    if (program.find('/') != std::string::npos) return fs::path(program).is_absolute() ? why_not(program) : why;
    const char* variable = std::getenv("PATH");
    std::istringstream folders(variable ? variable : "/bin:/usr/bin");
    for (std::string folder; std::getline(folders, folder, ':');) {
        if (!fs::path(folder).is_absolute()) continue;
        const std::string why_not_here = why_not(fs::path(folder) / program);
        if (why_not_here.empty()) return "";
        if (why_not_here != std::strerror(ENOENT)) why = why_not_here;
    }
    return why;
}

std::vector<PooledResult> run_in_pool(const std::vector<PooledWork>& work, int jobs, double then_s)
{
    std::vector<std::size_t> queue(work.size());
    std::iota(queue.begin(), queue.end(), 0);
    std::stable_sort(queue.begin(), queue.end(), [&](auto a, auto b) { return work[a].cost_s > work[b].cost_s; });

    std::vector<PooledResult> results(work.size());
    std::map<pid_t, Worker> workers;
    std::size_t next = 0;
    PoolProgress progress(work, jobs);
    while (next < queue.size() || !workers.empty()) {
        while (next < queue.size() && static_cast<int>(workers.size()) < jobs && !interrupted()) {
            const PooledWork& item = work[queue[next]];
            const ForkedProcess process = start_process([&] { return act_as_worker(item); });
            workers[process.id] = {queue[next++], process};
        }
        if (workers.empty()) break;
        int status = 0;
        rusage usage{};
        const pid_t process = wait_for_any(workers, status, usage);
        const auto found = workers.find(process);
        if (found == workers.end()) continue;
        const std::size_t index = found->second.work;
        results[index] = outcome_of(work[index], found->second.process, status);
        results[index].cpu_s = seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
        workers.erase(found);
        progress.ended(work[index], results[index], then_s);
    }
    stop_if_interrupted();
    return results;
}

}  // namespace experiments

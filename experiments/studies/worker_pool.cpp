#include "experiments/studies/worker_pool.hpp"

#include "experiments/interruption.hpp"
#include "experiments/progress.hpp"
#include "pbs/geometry/process.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/stopwatch.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <map>
#include <numeric>
#include <utility>

namespace experiments {
namespace {

struct Worker {
    std::size_t work = 0;
    int failure_pipe = -1;
    bool told_to_stop = false;
};

constexpr int failed = 1;
constexpr int refused = 2;
constexpr int broken_down = 3;
constexpr int stopped = 130;

[[noreturn]] void act_as_worker(const PooledWork& work, int failure_pipe)
{
    hide_progress();
    int status = 0;
    std::string text;
    try {
        text = work.action();
        if (!text.empty()) status = broken_down;
    } catch (const Interrupted&) {
        status = stopped;
    } catch (const pbs::InputError& error) {
        text = error.what();
        status = refused;
    } catch (const std::exception& error) {
        text = error.what();
        status = failed;
    }
    if (write(failure_pipe, text.data(), text.size()) < 0) std::perror("pbskin");
    std::fflush(nullptr);
    _exit(status);
}

Worker start(const PooledWork& work, std::size_t index, pid_t& process)
{
    int ends[2];
    if (pipe(ends) != 0) throw std::runtime_error("no pipe for a worker");
    std::fflush(nullptr);
    const pid_t parent = getpid();
    process = fork();
    if (process < 0) throw std::runtime_error("no process for a worker");
    if (process == 0) {
        pbs::end_with_parent(parent);
        close(ends[0]);
        act_as_worker(work, ends[1]);
    }
    close(ends[1]);
    return {index, ends[0]};
}

double seconds_of(const timeval& time)
{
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

std::string read_all(int pipe_end)
{
    std::string text;
    char buffer[4096];
    for (ssize_t count; (count = read(pipe_end, buffer, sizeof buffer)) > 0;) text.append(buffer, count);
    close(pipe_end);
    return text;
}

PooledResult outcome_of(const PooledWork& work, const Worker& worker, int status)
{
    const int exit = WIFEXITED(status) ? WEXITSTATUS(status) : failed;
    const std::string text = read_all(worker.failure_pipe);
    PooledResult result{work.name, exit == 0 || exit == broken_down, exit == broken_down ? text : "",
                        exit == 0 || exit == broken_down ? "" : text};
    result.refused = exit == refused;
    if (WIFSIGNALED(status)) result.failure = fmt::format("ended by signal {}", WTERMSIG(status));
    if (exit == stopped) result.failure = "interrupted";
    return result;
}

// The process that ended; an interruption is passed on to each of them, once: a second signal would end it in the middle of its work.
// A signal between the question and a wait without end would be seen when a worker ends; hence the short waits.
pid_t wait_for_any(std::map<pid_t, Worker>& workers, int& status, rusage& usage)
{
    constexpr int moment_ms = 20;
    for (;;) {
        if (interrupted())
            for (auto& [process, worker] : workers)
                if (!std::exchange(worker.told_to_stop, true)) kill(process, SIGTERM);
        const pid_t process = wait4(-1, &status, WNOHANG, &usage);
        if (process > 0) return process;
        if (process < 0 && errno != EINTR) throw std::runtime_error("the workers are gone");
        poll(nullptr, 0, moment_ms);
    }
}

}  // namespace

std::vector<PooledResult> run_in_pool(const std::vector<PooledWork>& work, int jobs, double then_s)
{
    std::vector<std::size_t> queue(work.size());
    std::iota(queue.begin(), queue.end(), 0);
    std::stable_sort(queue.begin(), queue.end(), [&](auto a, auto b) { return work[a].cost_s > work[b].cost_s; });

    std::vector<PooledResult> results(work.size());
    std::map<pid_t, Worker> workers;
    std::size_t next = 0, ended = 0;
    double done_s = 0.0;  // expected cost of what has ended
    const double total_s =
        std::accumulate(work.begin(), work.end(), 0.0, [](double sum, const PooledWork& item) { return sum + item.cost_s; });
    const pbs::Stopwatch stopwatch;
    while (next < queue.size() || !workers.empty()) {
        while (next < queue.size() && static_cast<int>(workers.size()) < jobs && !interrupted()) {
            pid_t process = 0;
            const Worker worker = start(work[queue[next]], queue[next], process);
            workers[process] = worker;
            ++next;
        }
        if (workers.empty()) break;
        int status = 0;
        rusage usage{};
        const pid_t process = wait_for_any(workers, status, usage);
        const auto found = workers.find(process);
        if (found == workers.end()) continue;
        const std::size_t index = found->second.work;
        results[index] = outcome_of(work[index], found->second, status);
        results[index].cpu_s = seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
        workers.erase(found);
        done_s += work[index].cost_s;
        const double left_s = done_s > 0.0 ? stopwatch.seconds() * (total_s - done_s) / done_s : 0.0;
        const double pace = done_s > 0.0 ? jobs * stopwatch.seconds() / done_s : 1.0;  // beside what was expected
        const std::string then = then_s > 0.0 ? fmt::format(", {:.0f} min in all", (left_s + std::min(pace, 4.0) * then_s) / 60.0) : "";
        spdlog::info("[{}/{}] {} {} after {:.0f} s, some {:.0f} s left{}", ++ended, work.size(), work[index].name,
                     results[index].finished ? "finished" : "failed: " + results[index].failure, stopwatch.seconds(), left_s, then);
    }
    stop_if_interrupted();
    return results;
}

}  // namespace experiments

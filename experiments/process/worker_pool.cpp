#include "experiments/process/child_process.hpp"

#include "experiments/process/terminal.hpp"
#include "pbs/geometry/cost.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <map>
#include <numeric>
#include <stdexcept>

namespace experiments {
namespace {

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
        done_s += work[index].cost_s;
        const double left_s = done_s > 0.0 ? stopwatch.seconds() * (total_s - done_s) / done_s : 0.0;
        const double pace = done_s > 0.0 ? jobs * stopwatch.seconds() / done_s : 1.0;  // seconds per expected second
        const std::string then = then_s > 0.0 ? fmt::format(", {:.0f} min in all", (left_s + std::min(pace, 4.0) * then_s) / 60.0) : "";
        spdlog::info("[{}/{}] {} {} after {:.0f} s, some {:.0f} s left{}", ++ended, work.size(), work[index].name,
                     results[index].finished ? "finished" : "failed: " + results[index].failure, stopwatch.seconds(), left_s, then);
    }
    stop_if_interrupted();
    return results;
}

}  // namespace experiments

#include "experiments/process/worker_pool.hpp"

#include "experiments/process/failure.hpp"
#include "experiments/process/interruption.hpp"
#include "experiments/process/process_pipe.hpp"
#include "experiments/process/progress.hpp"
#include "pbs/geometry/process.hpp"
#include "pbs/geometry/stopwatch.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <map>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace experiments {
namespace {

struct Worker {
    std::size_t work = 0;
    int words_from = -1;  // below 0: it has ended
    std::string words;
    bool told_to_stop = false;
};

[[noreturn]] void act_as_worker(const PooledWork& work, int words_to)
{
    hide_progress();
    int status = exit_finished;
    std::string words;
    try {
        words = work.action();
        if (!words.empty()) status = exit_breakdown;
    } catch (...) {
        const Failure failure = caught_failure();
        words = failure.message();
        status = failure.status;
    }
    write_whole(words_to, words);
    std::fflush(nullptr);
    _exit(status);
}

Worker start(const PooledWork& work, std::size_t index, pid_t& process)
{
    const ProcessPipe pipe = open_process_pipe();
    std::fflush(nullptr);
    const pid_t parent = getpid();
    process = fork();
    if (process < 0) throw std::runtime_error("no process for a worker");
    if (process == 0) {
        pbs::end_with_parent(parent);
        close(pipe.from);
        act_as_worker(work, pipe.to);
    }
    close(pipe.to);
    return {index, pipe.from, {}, false};
}

double seconds_of(const timeval& time)
{
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

// Taken while it works: a worker whose words fill the pipe waits until they are read.
void hear(Worker& worker)
{
    if (worker.words_from < 0 || read_available(worker.words_from, worker.words)) return;
    close(std::exchange(worker.words_from, -1));
}

PooledResult outcome_of(const PooledWork& work, Worker& worker, int status)
{
    hear(worker);
    if (worker.words_from >= 0) close(worker.words_from);
    const int exit = WIFEXITED(status) ? WEXITSTATUS(status) : exit_internal;
    const bool finished = exit == exit_finished || exit == exit_breakdown;
    PooledResult result{work.name, finished, exit == exit_breakdown ? worker.words : "", finished ? "" : worker.words};
    result.refused = exit == exit_input;
    if (WIFSIGNALED(status)) result.failure = fmt::format("ended by signal {}", WTERMSIG(status));
    if (exit == exit_interrupted) result.failure = "interrupted";
    return result;
}

// The process that ended; an interruption is passed on to each of them, once: a second signal would end it in the middle of its work.
// A signal between the question and a wait without end would be seen when a worker ends; hence the short waits.
pid_t wait_for_any(std::map<pid_t, Worker>& workers, int& status, rusage& usage)
{
    for (;;) {
        std::vector<int> ends;
        for (auto& [process, worker] : workers) {
            if (interrupted() && !std::exchange(worker.told_to_stop, true)) kill(process, SIGTERM);
            hear(worker);
            ends.push_back(worker.words_from);
        }
        const pid_t process = wait4(-1, &status, WNOHANG, &usage);
        if (process > 0) return process;
        if (process < 0 && errno != EINTR) throw std::runtime_error("the workers are gone");
        wait_for_words(ends);
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

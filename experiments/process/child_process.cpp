#include "experiments/process/child_process.hpp"

#include "analysis/records/record_files.hpp"
#include "experiments/process/terminal.hpp"
#include "pbs/geometry/cost.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/system/child_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spawn.h>
#include <spdlog/spdlog.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <thread>
#include <utility>

namespace experiments {
namespace {

constexpr int moment_ms = 50;  // between two looks for an interruption, which may arrive just before a wait

pbs::ChildEnd result_or_failure(const std::function<nlohmann::json()>& work)
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
    if (end.value("status", exit_internal) == exit_input)
        throw pbs::InputError("", 0, "", "", end.value("failure", ""));
    throw std::runtime_error(end.value("failure", ""));
}

std::string end_of(const std::string& text)
{
    constexpr std::size_t most = 400;
    const std::size_t end = text.find_last_not_of(" \t\r\n") + 1;
    return text.substr(end > most ? end - most : 0, std::min(end, most));
}

struct Worker {
    std::size_t work = 0;  // its number
    std::unique_ptr<pbs::ChildProcess> process;
};

pbs::ChildEnd act_as_worker(const PooledWork& work)
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

// Waits for the end of the worker.
PooledResult outcome_of(const PooledWork& work, pbs::ChildProcess& process)
{
    const int status = process.wait(), exit = WIFEXITED(status) ? WEXITSTATUS(status) : exit_internal;
    const bool finished = exit == exit_finished || exit == exit_breakdown;
    PooledResult result{work.name, finished, exit == exit_breakdown ? process.text() : "",
                        finished ? "" : process.text()};
    result.refused = exit == exit_input;
    if (WIFSIGNALED(status)) result.failure = fmt::format("ended by signal {}", WTERMSIG(status));
    if (exit == exit_interrupted) result.failure = "interrupted";
    return result;
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
        // seconds per expected second
        const double pace = done_s_ > 0.0 ? jobs_ * stopwatch_.seconds() / done_s_ : 1.0;
        const double all_left_min = (left_s + std::min(pace, 4.0) * then_s) / 60.0;
        spdlog::debug("{} {} after {:.0f} s", item.name, result.finished ? "finished" : "failed: " + result.failure,
                      stopwatch_.seconds());
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
    const NotedInterrupts noted;
    pbs::ChildProcess process([&] { return result_or_failure(work); });
    for (; process.writes(); pbs::listen_to({&process}, moment_ms)) stop_if_interrupted();
    const int status = process.wait();
    stop_if_interrupted();  // the same signal may have ended it
    if (WIFSIGNALED(status))
        throw pbs::InputError("", 0, "process", "signal " + std::to_string(WTERMSIG(status)),
                              "expected to end by itself");
    return result_in(process.text());
}

ProgramRun run_program(const std::vector<std::string>& program_and_arguments, const std::optional<std::string>& folder,
                       bool may_be_killed)
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
    const NotedInterrupts noted;
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
    constexpr int most_requests = 10;  // to end by itself, over half a second
    int status = 0, requests = 0;
    while (waitpid(child, &status, WNOHANG) == 0) {
        if (interrupted() && (may_be_killed || requests == 0))
            kill(child, ++requests > most_requests ? SIGKILL : SIGTERM);
        std::this_thread::sleep_for(std::chrono::milliseconds(moment_ms));
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

    const NotedInterrupts noted;
    std::vector<PooledResult> results(work.size());
    std::vector<Worker> workers;
    std::size_t next = 0;
    PoolProgress progress(work, jobs);
    while (next < queue.size() || !workers.empty()) {
        for (; next < queue.size() && static_cast<int>(workers.size()) < jobs; ++next) {
            const PooledWork& item = work[queue[next]];
            workers.push_back({queue[next], std::make_unique<pbs::ChildProcess>([&] { return act_as_worker(item); })});
        }
        std::vector<pbs::ChildProcess*> processes;
        for (const Worker& worker : workers) processes.push_back(worker.process.get());
        pbs::listen_to(processes, moment_ms);
        if (interrupted())
            for (pbs::ChildProcess* process : processes)
                process->ask_to_end();  // all at once; the destructors wait for one after the other
        stop_if_interrupted();
        std::erase_if(workers, [&](const Worker& worker) {
            if (worker.process->writes()) return false;
            results[worker.work] = outcome_of(work[worker.work], *worker.process);
            progress.ended(work[worker.work], results[worker.work], then_s);
            return true;
        });
    }
    stop_if_interrupted();  // a worker that was interrupted too has not failed
    return results;
}

}  // namespace experiments

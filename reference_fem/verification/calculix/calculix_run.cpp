#include "reference_fem/verification/calculix/calculix_run.hpp"

#include "analysis/records/record_files.hpp"
#include "pbs/geometry/cost.hpp"
#include "pbs/geometry/input_error.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <vector>

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace reference_fem {
namespace {

namespace fs = std::filesystem;

std::string text_of(const std::string& path)
{
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

// This process's environment with one thread for every library that CalculiX may be linked with.
std::vector<std::string> one_thread_environment()
{
    const std::vector<std::string> ours = {"OMP_NUM_THREADS=1", "OPENBLAS_NUM_THREADS=1", "CCX_NPROC_EQUATION_SOLVER=1",
                                           "NUMBER_OF_CPUS=1"};
    std::vector<std::string> variables = ours;
    for (char** variable = environ; *variable; ++variable) {
        const std::string theirs = *variable;
        const std::string name = theirs.substr(0, theirs.find('=') + 1);
        if (std::none_of(ours.begin(), ours.end(), [&](const auto& one) { return one.starts_with(name); })) variables.push_back(theirs);
    }
    return variables;
}

bool wait_until_closed(int pipe, double seconds)
{
    const pbs::Stopwatch stopwatch;
    for (double left = seconds; left > 0.0; left = seconds - stopwatch.seconds()) {
        pollfd waiting{pipe, POLLIN, 0};
        if (poll(&waiting, 1, static_cast<int>(std::min(1000.0 * left + 1.0, 1e6))) > 0) return true;
    }
    return false;
}

// The child's surroundings: `folder` as its working directory, its output in a file there, and the writing end of a pipe that closes when
// it ends.
class SpawnActions {
public:
    SpawnActions(const std::string& folder, int pipe_end)
    {
        constexpr int free_descriptor = 3;
        posix_spawn_file_actions_init(&actions_);
        posix_spawn_file_actions_addchdir_np(&actions_, folder.c_str());
        posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
        posix_spawn_file_actions_addopen(&actions_, STDOUT_FILENO, "output.txt", O_WRONLY | O_CREAT | O_TRUNC, 0644);
        posix_spawn_file_actions_adddup2(&actions_, STDOUT_FILENO, STDERR_FILENO);
        posix_spawn_file_actions_adddup2(&actions_, pipe_end, free_descriptor);
    }
    ~SpawnActions() { posix_spawn_file_actions_destroy(&actions_); }
    SpawnActions(const SpawnActions&) = delete;
    SpawnActions& operator=(const SpawnActions&) = delete;

    const posix_spawn_file_actions_t* get() const { return &actions_; }

private:
    posix_spawn_file_actions_t actions_;
};

// `program OPTION deck` in a folder; finished where it ended by itself, in time and with exit status 0.
CalculixOutcome run_in(const std::string& folder, const std::string& program, const char* option, double limit_s, double& cpu_s)
{
    std::vector<std::string> variables = one_thread_environment();
    std::vector<char*> environment;
    for (std::string& variable : variables) environment.push_back(variable.data());
    environment.push_back(nullptr);
    const std::array<const char*, 4> arguments = {program.c_str(), option, "deck", nullptr};

    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) return CalculixOutcome::not_started;
    pid_t child = 0;
    const SpawnActions actions(folder, ends[1]);
    const bool started =
        posix_spawn(&child, program.c_str(), actions.get(), nullptr, const_cast<char* const*>(arguments.data()), environment.data()) == 0;
    close(ends[1]);
    const bool in_time = started && wait_until_closed(ends[0], limit_s);
    close(ends[0]);
    if (!started) return CalculixOutcome::not_started;
    if (!in_time) kill(child, SIGKILL);
    int status = 0;
    rusage usage{};
    while (wait4(child, &status, 0, &usage) < 0 && errno == EINTR) {
    }
    const auto seconds = [](const timeval& time) { return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec); };
    cpu_s = seconds(usage.ru_utime) + seconds(usage.ru_stime);
    if (!in_time) return CalculixOutcome::out_of_time;
    return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? CalculixOutcome::finished : CalculixOutcome::refused;
}

}  // namespace

const char* name_of(CalculixOutcome outcome)
{
    constexpr std::array<const char*, 4> names = {"finished", "refused", "out of time", "not started"};
    return names[static_cast<std::size_t>(outcome)];
}

std::string last_words(const std::string& output)
{
    constexpr std::size_t most = 400;
    const std::size_t end = output.find_last_not_of(" \t\r\n") + 1;
    return output.substr(end > most ? end - most : 0, std::min(end, most));
}

std::optional<std::string> calculix_on_path()
{
    const char* path = std::getenv("PATH");
    std::istringstream folders(path ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');) {
        const fs::path program = fs::absolute(fs::path(folder.empty() ? "." : folder) / "ccx");
        std::error_code ignored;
        if (fs::is_regular_file(program, ignored) && access(program.c_str(), X_OK) == 0) return program.string();
    }
    return std::nullopt;
}

std::string calculix_version(const std::string& program)
{
    const analysis::ScratchFolder folder;
    double cpu_s = 0.0;
    run_in(folder.path(), program, "-v", 10.0, cpu_s);
    const std::string output = text_of(folder / "output.txt");
    std::smatch match;
    return std::regex_search(output, match, std::regex(R"(Version\s+([\w.]+))")) ? "CalculiX " + match[1].str() : "unknown version";
}

CalculixRun run_calculix(const std::string& program, const std::function<void(std::ostream&)>& write_deck, const CalculixLimits& limits)
{
    const analysis::ScratchFolder folder;
    {
        std::ofstream deck(folder / "deck.inp");
        write_deck(deck);
        if (!deck.flush()) throw pbs::InputError(folder / "deck.inp", 0, "", "", "cannot be written: is there space for CalculiX's deck?");
    }
    CalculixRun run;
    const pbs::Stopwatch stopwatch;
    run.outcome = run_in(folder.path(), program, "-i", limits.seconds, run.cpu_s);
    run.wall_s = stopwatch.seconds();
    run.output = text_of(folder / "output.txt");
    run.printed = text_of(folder / "deck.dat");
    run.restart = text_of(folder / "deck.rout");
    if (run.outcome == CalculixOutcome::finished && run.output.find("*ERROR") != std::string::npos) run.outcome = CalculixOutcome::refused;
    return run;
}

}  // namespace reference_fem

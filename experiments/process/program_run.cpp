#include "experiments/process/program_run.hpp"

#include "analysis/records/record_files.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace experiments {
namespace {

std::string end_of(const std::string& text)
{
    constexpr std::size_t most = 400;
    const std::size_t end = text.find_last_not_of(" \t\r\n") + 1;
    return text.substr(end > most ? end - most : 0, std::min(end, most));
}

}  // namespace

ProgramRun run_program(const std::vector<std::string>& program_and_arguments, const std::string& folder)
{
    std::vector<std::string> words = program_and_arguments;
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);

    const std::string output = (std::filesystem::path(folder) / "output.txt").string();
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
    posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
    pid_t child = 0;
    ProgramRun run;
    const int failure = posix_spawnp(&child, arguments.front(), &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    run.started = failure == 0;
    if (!run.started) {
        run.last_words = std::strerror(failure);
        return run;
    }
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (WIFEXITED(status)) run.status = WEXITSTATUS(status);
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

}  // namespace experiments

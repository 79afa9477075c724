#include "experiments/command_line/report_page.hpp"

#include "analysis/records/record_files.hpp"
#include "experiments/process/program_run.hpp"
#include "pbs/geometry/input_error.hpp"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>

namespace experiments {
namespace {

namespace fs = std::filesystem;

// In a build as in an installation, share/pbskin is next to the folder of the program.
fs::path page_maker()
{
    return fs::read_symlink("/proc/self/exe").parent_path().parent_path() / "share/pbskin/paper_figures/make_report.py";
}

// Debian's python3 comes first, for one of a version manager on the PATH often lacks the packages that the figures need.
std::string python_that_draws()
{
    const analysis::ScratchFolder scratch;
    for (const char* python : {"/usr/bin/python3", "python3"})
        if (run_program({python, "-c", "import numpy, matplotlib"}, scratch.path()).succeeded()) return python;
    throw pbs::InputError("", 0, "report", "",
                          "no python3 that can import numpy and matplotlib: install python3-numpy and python3-matplotlib");
}

}  // namespace

int write_report_page(const std::string& folder, bool quiet)
{
    if (!fs::is_directory(folder))
        throw pbs::InputError(folder, 0, "", "", "no such folder: expected one that `pbskin try`, `run` or `reproduce` wrote");
    if (!fs::is_regular_file(page_maker()))
        throw pbs::InputError(page_maker().string(), 0, "", "",
                              "not found: the page is made by scripts that are installed with the program");
    std::vector<std::string> words = {python_that_draws(), "-B", page_maker().string(), folder};
    if (quiet) words.push_back("--quiet");
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    std::fflush(nullptr);
    pid_t process = 0;
    if (posix_spawnp(&process, arguments.front(), nullptr, nullptr, arguments.data(), environ) != 0)
        throw pbs::InputError("", 0, "report", words.front(), "cannot be started");
    int status = 0;
    while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace experiments

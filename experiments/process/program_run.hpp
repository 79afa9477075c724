// Runs another program, found on the PATH, without a shell.
//   const ProgramRun packed = run_program({"npm", "pack", "name@1.0.0"}, folder);
#pragma once

#include <string>
#include <vector>

namespace experiments {

struct ProgramRun {
    bool started = false;
    int status = -1;         // its exit status; -1: it ended by a signal or did not start
    std::string last_words;  // the end of its output; the reason if it did not start

    bool succeeded() const { return started && status == 0; }
};

// The program runs in `folder`, which must exist. Its output is in a file there while it runs.
ProgramRun run_program(const std::vector<std::string>& program_and_arguments, const std::string& folder);

// Returns why the program, a path or a name on the PATH, cannot be started, or an empty text if it can. Relative paths and relative entries
// of the PATH count as missing, for run_program changes to its folder before it seeks the program.
std::string why_not_startable(const std::string& program);

}  // namespace experiments

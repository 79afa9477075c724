// Another program, run without a shell, looked for on the PATH.
//   const ProgramRun packed = run_program({"npm", "pack", "name@1.0.0"}, folder);
#pragma once

#include <string>
#include <vector>

namespace experiments {

struct ProgramRun {
    bool started = false;
    int status = -1;         // its exit status; -1: it ended by a signal, or never started
    std::string last_words;  // the end of what it wrote

    bool succeeded() const { return started && status == 0; }
};

// In `folder`, which is there; what it writes goes into a file there for as long as it runs.
ProgramRun run_program(const std::vector<std::string>& program_and_arguments, const std::string& folder);

}  // namespace experiments

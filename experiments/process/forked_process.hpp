// A forked process that returns a text to its parent, however long the text is. It ends with its parent, however that ends.
//   ForkedProcess process = start_process([] { return ProcessEnd{"text", exit_finished}; });
//   while (process.from >= 0) wait_for_text({process.from}), listen(process);
#pragma once

#include <sys/types.h>

#include <functional>
#include <string>
#include <vector>

namespace experiments {

struct ProcessEnd {
    std::string text;
    int status = 0;
};

struct ForkedProcess {
    pid_t id = -1;
    int from = -1;          // the pipe that its text comes from; below 0 when no process can write any more
    std::string text = {};  // as far as it has arrived
    bool told_to_stop = false;
};

// std::runtime_error where no process or pipe can be had. Programs that either process starts do not inherit the pipe.
ForkedProcess start_process(const std::function<ProcessEnd()>& work);

// Appends what has arrived without waiting. Parents must listen while the process works, for it waits when the pipe is full.
void listen(ForkedProcess& process);

// Passes an interruption of this process on to a process that has not been waited for, once: a second signal would end its work in the
// middle.
void pass_on_interruption(ForkedProcess& process);

// Waits until one of the pipes has something to read, but only for a moment, so that a signal before the wait is noticed after it.
// Pipes below 0 are left out.
void wait_for_text(const std::vector<int>& pipes);

}  // namespace experiments

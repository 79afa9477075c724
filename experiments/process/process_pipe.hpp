// What a forked process tells its parent: whole, however long it is, and without waiting where nothing is there yet.
//   const ProcessPipe pipe = open_process_pipe();
//   if (fork() == 0) { close(pipe.from); write_whole(pipe.to, text); _exit(0); }
//   close(pipe.to);  while (read_available(pipe.from, text)) wait_for_words({pipe.from});
#pragma once

#include <string>
#include <vector>

namespace experiments {

struct ProcessPipe {
    int from = -1;  // the parent reads; never waits
    int to = -1;    // the child writes
};

// Programs that either process starts do not inherit it. std::runtime_error where there is none.
ProcessPipe open_process_pipe();

// Until all is written, signals or not, or nobody reads any more.
void write_whole(int to, const std::string& text);

// Appends what is there; false at the end, when no process can write any more.
bool read_available(int from, std::string& text);

// Until one of them has something to read, or for a moment: a signal before the wait is seen after it. Ends below 0 are left out.
void wait_for_words(const std::vector<int>& ends);

}  // namespace experiments

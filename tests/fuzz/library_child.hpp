// Runs a library on any bytes in a child process, as child_process.hpp does, and distinguishes the library's own
// breakdowns, which the child contains, from those of the project's code after it.
//   const LibraryChild child([&](LibraryChild::Parent& parent) { ...; parent.library_is_done(); ... });
//   if (child.broke_down_in_library()) return;   // the user gets an InputError
// The child's coverage counts as that of the fuzzed program: libFuzzer adds the bytes of the section
// __libfuzzer_extra_counters to its own.
#pragma once

#include "pbs/geometry/input_error.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <fstream>
#include <functional>
#include <string>

// The counters of the instrumented code; null in a program without them.
extern "C" {
extern std::uint8_t __start___sancov_cntrs[] __attribute__((weak));
extern std::uint8_t __stop___sancov_cntrs[] __attribute__((weak));
}

namespace fuzz {

inline constexpr std::size_t most_counters = 1 << 16;
alignas(4096) __attribute__((section("__libfuzzer_extra_counters"))) inline std::uint8_t shared_counters[most_counters];

inline void share_counters()
{
    static const bool shared = mmap(shared_counters, sizeof shared_counters, PROT_READ | PROT_WRITE,
                                    MAP_SHARED | MAP_ANONYMOUS | MAP_FIXED, -1, 0) != MAP_FAILED;
    if (!shared) std::abort();
}

inline void keep_coverage()
{
    if (!__start___sancov_cntrs) return;
    const auto count = static_cast<std::size_t>(__stop___sancov_cntrs - __start___sancov_cntrs);
    std::memcpy(shared_counters, __start___sancov_cntrs, std::min(count, most_counters));
}

// An input that the library refuses is not kept, since nearly all of its mutations would be refused as well.
inline void forget_coverage()
{
    std::memset(shared_counters, 0, sizeof shared_counters);
    if (__start___sancov_cntrs)
        std::memset(__start___sancov_cntrs, 0,
                    static_cast<std::size_t>(__stop___sancov_cntrs - __start___sancov_cntrs));
}

inline void limit_child()
{
    constexpr rlim_t seconds = 2, bytes = rlim_t(1) << 30;
    std::uintmax_t ignored = 0, pages = 0;
    std::ifstream statm("/proc/self/statm");
    for (int column = 0; column < 5; ++column) statm >> ignored;
    statm >> pages;  // of data and stack, with the addresses that a sanitizer reserves
    const rlimit time{seconds, seconds}, core{0, 0},
        data{pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + bytes, RLIM_INFINITY};
    setrlimit(RLIMIT_CPU, &time);
    setrlimit(RLIMIT_CORE, &core);
    setrlimit(RLIMIT_DATA, &data);
}

class LibraryChild {
public:
    class Parent {
    public:
        explicit Parent(int pipe) : pipe_(pipe) {}
        // From here on a breakdown is one of the project's code, and is reported.
        void library_is_done()
        {
            dup2(errors_, STDERR_FILENO);
            send('s');
        }
        void send(char byte) const
        {
            if (::write(pipe_, &byte, 1) != 1) _exit(1);
        }
        void silence()
        {
            errors_ = dup(STDERR_FILENO);
            const int nothing = open("/dev/null", O_WRONLY);
            dup2(nothing, STDOUT_FILENO);
            dup2(nothing, STDERR_FILENO);
        }

    private:
        int pipe_, errors_ = -1;
    };

    explicit LibraryChild(const std::function<void(Parent&)>& work)
    {
        share_counters();
        int ends[2];
        if (pipe(ends) != 0) std::abort();
        const pid_t child = fork();
        if (child < 0) std::abort();
        if (child == 0) {
            close(ends[0]);
            run(Parent(ends[1]), work);
        }
        close(ends[1]);
        for (char byte = 0; ::read(ends[0], &byte, 1) == 1;) sent_ += byte;
        close(ends[0]);
        while (waitpid(child, &status_, 0) < 0) {
        }
        if (!is_whole()) forget_coverage();
        count_breakdowns();
    }

    bool is_whole() const { return status_ == 0 && sent_ == "se"; }
    bool broke_down_in_library() const { return status_ != 0 && sent_.empty(); }
    bool broke_down_after_library() const { return status_ != 0 && !sent_.empty(); }

private:
    [[noreturn]] static void run(Parent parent, const std::function<void(Parent&)>& work)
    {
        for (const int signal : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGTERM, SIGXCPU})
            std::signal(signal, SIG_DFL);
        limit_child();
        parent.silence();
        try {
            work(parent);
            keep_coverage();
            parent.send('e');
        } catch (const std::exception&) {  // try_reading turns all of them into InputErrors
        }
        _exit(0);
    }

    // Printed at the end of the program: targets.py reports the numbers.
    void count_breakdowns() const
    {
        struct Counts {
            long runs = 0, whole = 0, by_signal = 0, at_limit = 0, otherwise = 0;
            ~Counts()
            {
                std::fprintf(
                    stderr,
                    "library: %ld runs, %ld read, %ld ended by a signal, %ld at the time limit, %ld ended otherwise\n",
                    runs, whole, by_signal, at_limit, otherwise);
            }
        };
        static Counts counts;
        ++counts.runs;
        counts.whole += is_whole();
        if (!broke_down_in_library()) return;
        const bool at_limit = WIFSIGNALED(status_) && (WTERMSIG(status_) == SIGXCPU || WTERMSIG(status_) == SIGKILL);
        counts.at_limit += at_limit;
        counts.by_signal += WIFSIGNALED(status_) && !at_limit;
        counts.otherwise += !WIFSIGNALED(status_);
    }

    std::string sent_;  // "s" once the library is done, "e" at the end
    int status_ = 0;
};

// For reports to the library's authors: PBS_FUZZ_BREAKDOWNS names a folder for the inputs on which it broke down.
inline void keep_breakdown(const std::string& bytes)
{
    static int count = 0;
    const char* folder = std::getenv("PBS_FUZZ_BREAKDOWNS");
    if (!folder) return;
    std::ofstream(std::string(folder) + "/" + std::to_string(getpid()) + "_" + std::to_string(count++),
                  std::ios::binary)
        << bytes;
}

}  // namespace fuzz

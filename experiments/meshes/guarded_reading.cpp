#include "experiments/meshes/guarded_reading.hpp"

#include "pbs/geometry/cost.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/system/child_process.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <limits>
#include <new>
#include <optional>
#include <sstream>
#include <stdexcept>

namespace pbs {
namespace {

#ifndef __has_feature  // clang's
#define __has_feature(feature) 0
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || __has_feature(address_sanitizer) || \
    __has_feature(thread_sanitizer)
constexpr bool sanitized = true;  // slow, and terabytes of addresses are reserved
#else
constexpr bool sanitized = false;
#endif

// Far above what a sound file needs. Time is longer than processor time, for machines that are busy with other work.
constexpr double base_limit_s = 20.0, limit_s_per_megabyte = 10.0;
constexpr double base_cpu_limit_s = sanitized ? 20.0 : 4.0, cpu_limit_s_per_megabyte = sanitized ? 10.0 : 2.0;
constexpr std::uintmax_t base_limit_bytes = std::uintmax_t(1) << 30, limit_bytes_per_byte = 200;

std::uintmax_t bytes_of(const std::string& path)
{
    std::error_code code;
    const std::uintmax_t bytes = std::filesystem::file_size(path, code);
    return code ? 0 : bytes;
}

// Half of the memory that the machine has available: the parent reads the file too.
std::uintmax_t most_bytes_now()
{
    std::ifstream file("/proc/meminfo");
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line);
        std::string word;
        std::uintmax_t kilobytes = 0;
        if (words >> word >> kilobytes && word == "MemAvailable:") return kilobytes * 1024 / 2;
    }
    return std::numeric_limits<std::uintmax_t>::max();
}

void limit(int resource, std::uintmax_t most)
{
    rlimit now{};
    getrlimit(resource, &now);
    const rlimit wanted{std::min<rlim_t>(most, now.rlim_max), now.rlim_max};
    setrlimit(resource, &wanted);
}

// Limits this process from here on: memory, processor time and no core file. Memory is not limited under a sanitizer.
void limit_reading(const std::string& path)
{
    const std::uintmax_t file_bytes = bytes_of(path);
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_CPU, static_cast<std::uintmax_t>(base_cpu_limit_s +
                                                  cpu_limit_s_per_megabyte * 1e-6 * static_cast<double>(file_bytes)));
    if (sanitized) return;
    std::uintmax_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const std::uintmax_t own = pages * static_cast<std::uintmax_t>(sysconf(_SC_PAGESIZE));
    limit(RLIMIT_AS, own + std::min(base_limit_bytes + limit_bytes_per_byte * file_bytes, most_bytes_now()));
}

constexpr const char* too_much_memory = "damaged: asks for more memory than such a file can need";

// "+" where the file was read, otherwise "-" and the words of the error.
std::string answer_to(const std::string& path, const std::function<void(const std::string&)>& read)
{
    try {
        read(path);
        return "+";
    } catch (const InputError& error) {
        return std::string("-") + error.what();
    } catch (const std::bad_alloc&) {
        return "-" + path + ": " + too_much_memory;
    } catch (const std::length_error&) {
        return "-" + path + ": " + too_much_memory;
    } catch (const std::exception& error) {
        return "-" + path + ": " + error.what();
    }
}

ChildEnd answer_as_child(const std::string& path, const std::function<void(const std::string&)>& read)
{
    for (const int signal : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGTERM, SIGINT}) std::signal(signal, SIG_DFL);
    const int nothing = open("/dev/null", O_WRONLY | O_CLOEXEC);
    for (const int output : {STDOUT_FILENO, STDERR_FILENO}) dup2(nothing, output);
    limit_reading(path);
    return {answer_to(path, read)};
}

// False when the time is up before the child has ended [s].
bool ends_within(double limit_s, ChildProcess& child)
{
    const Stopwatch stopwatch;
    while (child.writes()) {
        const double left_s = limit_s - stopwatch.seconds();
        if (left_s <= 0.0) return false;
        listen_to({&child}, static_cast<int>(1e3 * left_s) + 1);
    }
    return true;
}

// Why a child ended that sent no answer.
std::string death(int status)
{
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU) return "took more processor time than such a file can need";
    if (WIFSIGNALED(status)) return std::string("broke down on it: ") + strsignal(WTERMSIG(status));
    return "ended in the middle, with exit status " + std::to_string(WEXITSTATUS(status));
}

}  // namespace

void try_reading(const std::string& path, const std::function<void(const std::string&)>& read)
{
    std::optional<ChildProcess> child;
    try {
        child.emplace([&] { return answer_as_child(path, read); });
    } catch (const InputError& error) {
        throw InputError(path, 0, "", "", std::string("cannot be read: ") + error.what());
    }
    // [s] of time, not of processor time: other work may keep the machine busy.
    const double limit_s = base_limit_s + limit_s_per_megabyte * 1e-6 * static_cast<double>(bytes_of(path));
    if (!ends_within(limit_s, *child)) throw InputError(path, 0, "", "", "damaged: the reader did not end");
    const int status = child->wait();
    const std::string& answer = child->text();
    if (status != 0 || answer.empty()) throw InputError(path, 0, "", "", "damaged: the reader " + death(status));
    if (answer[0] != '+') throw InputError("", 0, "", "", answer.substr(1));
}

}  // namespace pbs

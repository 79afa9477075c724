#include "pbs/geometry/guarded_reading.hpp"

#include "pbs/geometry/input_error.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <new>

namespace pbs {
namespace {

enum class Answer : char { mesh, error };

// Far above what a sound file needs, on a busy machine and under sanitizers too.
constexpr double base_limit_s = 10.0, limit_s_per_megabyte = 10.0;
constexpr std::uintmax_t base_limit_bytes = std::uintmax_t(1) << 30, limit_bytes_per_byte = 200;

void append(std::string& bytes, const void* data, std::size_t size)
{
    bytes.append(static_cast<const char*>(data), size);
}

std::string packed(const IndexedPoints& mesh)
{
    std::string bytes(1, static_cast<char>(Answer::mesh));
    const Eigen::Index sizes[3] = {mesh.points.rows(), mesh.cells.rows(), mesh.cells.cols()};
    append(bytes, sizes, sizeof sizes);
    append(bytes, mesh.points.data(), static_cast<std::size_t>(mesh.points.size()) * sizeof(double));
    append(bytes, mesh.cells.data(), static_cast<std::size_t>(mesh.cells.size()) * sizeof(int));
    return bytes;
}

// False when the bytes are not a whole packed mesh: the child died on the way.
bool unpack(const std::string& bytes, IndexedPoints& mesh)
{
    Eigen::Index sizes[3] = {};
    if (bytes.size() < 1 + sizeof sizes) return false;
    std::memcpy(sizes, bytes.data() + 1, sizeof sizes);
    mesh.points.resize(sizes[0], 3);
    mesh.cells.resize(sizes[1], sizes[2]);
    const std::size_t point_bytes = static_cast<std::size_t>(mesh.points.size()) * sizeof(double);
    const std::size_t cell_bytes = static_cast<std::size_t>(mesh.cells.size()) * sizeof(int);
    if (bytes.size() != 1 + sizeof sizes + point_bytes + cell_bytes) return false;
    if (point_bytes > 0) std::memcpy(mesh.points.data(), bytes.data() + 1 + sizeof sizes, point_bytes);
    if (cell_bytes > 0) std::memcpy(mesh.cells.data(), bytes.data() + 1 + sizeof sizes + point_bytes, cell_bytes);
    return true;
}

void limit_memory([[maybe_unused]] std::uintmax_t file_bytes)
{
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // these reserve terabytes of addresses
    std::uintmax_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const rlim_t bytes = pages * static_cast<std::uintmax_t>(sysconf(_SC_PAGESIZE)) + base_limit_bytes + limit_bytes_per_byte * file_bytes;
    const rlimit limit{bytes, bytes};
    setrlimit(RLIMIT_AS, &limit);
#endif
}

void silence()
{
    const int nothing = open("/dev/null", O_WRONLY | O_CLOEXEC);
    dup2(nothing, STDOUT_FILENO);
    dup2(nothing, STDERR_FILENO);
}

[[noreturn]] void answer_as_child(int pipe, const std::string& path, const std::function<IndexedPoints(const std::string&)>& read)
{
    for (const int signal : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGTERM}) std::signal(signal, SIG_DFL);
    std::signal(SIGINT, SIG_IGN);  // the parent decides
    const rlimit no_core{0, 0};
    setrlimit(RLIMIT_CORE, &no_core);
    silence();
    std::error_code code;
    limit_memory(std::filesystem::file_size(path, code));

    std::string bytes(1, static_cast<char>(Answer::error));
    try {
        bytes = packed(read(path));
    } catch (const InputError& error) {
        bytes += error.what();
    } catch (const std::bad_alloc&) {
        bytes += path + ": damaged: asks for more memory than such a file can need";
    } catch (const std::exception& error) {
        bytes += path + ": " + error.what();
    }
    for (std::size_t at = 0; at < bytes.size();) {
        const ssize_t count = ::write(pipe, bytes.data() + at, bytes.size() - at);
        if (count <= 0) break;
        at += static_cast<std::size_t>(count);
    }
    _exit(0);
}

// Everything the child writes until it closes the pipe; false when the time is up.
bool collect(int pipe, double limit_s, std::string& bytes)
{
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(limit_s);
    char buffer[1 << 16];
    for (;;) {
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now()).count();
        if (left <= 0) return false;
        pollfd waiting{pipe, POLLIN, 0};
        if (poll(&waiting, 1, static_cast<int>(std::min<long long>(left, 1000))) <= 0) continue;
        const ssize_t count = ::read(pipe, buffer, sizeof buffer);
        if (count == 0) return true;
        if (count > 0) bytes.append(buffer, static_cast<std::size_t>(count));
    }
}

}  // namespace

IndexedPoints read_guarded(const std::string& path, const std::function<IndexedPoints(const std::string&)>& read)
{
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) throw InputError(path, 0, "", "", std::string("cannot be read: ") + std::strerror(errno));
    const pid_t child = fork();
    if (child < 0) throw InputError(path, 0, "", "", std::string("cannot be read: ") + std::strerror(errno));
    if (child == 0) answer_as_child(ends[1], path, read);

    close(ends[1]);
    std::error_code code;
    const double megabytes = 1e-6 * static_cast<double>(std::filesystem::file_size(path, code));
    std::string bytes;
    const bool in_time = collect(ends[0], base_limit_s + limit_s_per_megabyte * megabytes, bytes);
    close(ends[0]);
    if (!in_time) kill(child, SIGKILL);
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }

    if (!in_time) throw InputError(path, 0, "", "", "damaged: the reader did not end");
    if (!bytes.empty() && bytes[0] == static_cast<char>(Answer::error)) throw InputError("", 0, "", "", bytes.substr(1));
    IndexedPoints mesh;
    if (bytes.empty() || !unpack(bytes, mesh)) throw InputError(path, 0, "", "", "damaged: the reader broke down on it");
    return mesh;
}

}  // namespace pbs

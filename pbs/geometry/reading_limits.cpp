#include "pbs/geometry/reading_limits.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

namespace pbs {
namespace {

#ifndef __has_feature  // clang's
#define __has_feature(feature) 0
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
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

// Half of the memory that the machine has available: the parent holds the result too.
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

}  // namespace

double reading_limit_s(const std::string& path)
{
    return base_limit_s + limit_s_per_megabyte * 1e-6 * static_cast<double>(bytes_of(path));
}

void limit_reading(const std::string& path)
{
    const std::uintmax_t file_bytes = bytes_of(path);
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_CPU, static_cast<std::uintmax_t>(base_cpu_limit_s + cpu_limit_s_per_megabyte * 1e-6 * static_cast<double>(file_bytes)));
    if (sanitized) return;
    std::uintmax_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const std::uintmax_t own = pages * static_cast<std::uintmax_t>(sysconf(_SC_PAGESIZE));
    limit(RLIMIT_AS, own + std::min(base_limit_bytes + limit_bytes_per_byte * file_bytes, most_bytes_now()));
}

}  // namespace pbs

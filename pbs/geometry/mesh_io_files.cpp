// Paths, temporary files and index ranges: what every format needs.
#include "pbs/geometry/mesh_io_formats.hpp"

#include "pbs/geometry/input_error.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace pbs {

namespace fs = std::filesystem;

std::string lower_extension(const std::string& path)
{
    std::string extension = fs::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return std::tolower(c); });
    return extension;
}

void require_readable(const std::string& path, std::uintmax_t most_bytes)
{
    std::error_code code;
    if (!fs::exists(path, code)) throw InputError(path, 0, "", "", "no such file");
    if (!fs::is_regular_file(path, code)) throw InputError(path, 0, "", "", "expected a file");
    if (!std::ifstream(path)) throw InputError(path, 0, "", "", "cannot be read");
    const std::uintmax_t bytes = fs::file_size(path, code);
    if (code) throw InputError(path, 0, "", "", "cannot be read: " + code.message());
    if (bytes == 0) throw InputError(path, 0, "", "", "the file is empty");
    require_size(path, bytes, most_bytes);
}

int checked_index(const std::string& path, long long tet, long long index, long long points)
{
    if (index < 0 || index >= points)
        throw InputError(path, 0, "tet " + std::to_string(tet) + " vertex", std::to_string(index),
                         "expected an index from 0 to " + std::to_string(points - 1));
    return static_cast<int>(index);
}

namespace {

bool write_and_flush(int file, const std::string& bytes)
{
    for (std::size_t at = 0; at < bytes.size();) {
        const ssize_t count = ::write(file, bytes.data() + at, bytes.size() - at);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return false;
        at += static_cast<std::size_t>(count);
    }
    return ::fsync(file) == 0;  // a full disk may say so no earlier
}

}  // namespace

void write_atomically(const std::string& path, const std::string& bytes)
{
    const fs::path target(path);
    const std::string name = std::string(".") + target.stem().string() + "." + std::to_string(getpid()) + target.extension().string();
    const std::string temporary = (target.parent_path() / name).string();
    const int file = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    int reason = file >= 0 && write_and_flush(file, bytes) ? 0 : errno;
    if (file >= 0 && ::close(file) != 0 && reason == 0) reason = errno;
    if (reason == 0 && std::rename(temporary.c_str(), path.c_str()) != 0) reason = errno;
    if (reason == 0) return;
    ::unlink(temporary.c_str());
    throw InputError(path, 0, "", "", "cannot be written: " + std::generic_category().message(reason));
}

}  // namespace pbs

#include "pbs/geometry/atomic_file.hpp"

#include "pbs/geometry/input_error.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <random>
#include <string_view>
#include <system_error>

namespace pbs {
namespace {

constexpr std::size_t most_name_bytes = 200;  // of NAME: with what is added it stays below the 255 that a file system allows

std::string beginning_of_temporary(const std::string& path)
{
    const std::filesystem::path target(path);
    const std::string name = target.filename().string().substr(0, most_name_bytes);
    return (target.parent_path() / ("." + name + "." + std::to_string(getpid()) + ".")).string();
}

std::string random_letters(int count)
{
    constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyz0123456789";
    std::random_device device;
    std::uniform_int_distribution<std::size_t> any(0, letters.size() - 1);
    std::string text;
    for (int i = 0; i < count; ++i) text += letters[any(device)];
    return text;
}

// Like mkstemp(3), with the permissions of any new file: an existing entry, such as a link, is not opened.
int open_new(const std::string& beginning, std::string& name)
{
    for (int tries = 0; tries < 100; ++tries) {
        name = beginning + random_letters(6);
        const int file = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (file >= 0 || errno != EEXIST) return file;
    }
    return -1;
}

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

// The new name survives a loss of power, too. File systems that cannot flush a folder keep no such promise.
void flush_folder_of(const std::string& path)
{
    const std::filesystem::path parent = std::filesystem::path(path).parent_path();
    const int folder = ::open(parent.empty() ? "." : parent.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder < 0) return;
    ::fsync(folder);
    ::close(folder);
}

[[noreturn]] void refuse(const std::string& path, int reason)
{
    throw InputError(path, 0, "", "", "cannot be written: " + std::generic_category().message(reason));
}

}  // namespace

void require_no_device(const std::string& path)
{
    std::error_code error;
    const auto kind = std::filesystem::status(path, error).type();
    using enum std::filesystem::file_type;
    if (kind == character || kind == block || kind == fifo || kind == socket)
        throw InputError(path, 0, "", "", "cannot be written: expected a file, or nothing there");
}

void write_atomically(const std::string& path, const std::string& bytes)
{
    require_no_device(path);
    std::string temporary;
    const int file = open_new(beginning_of_temporary(path), temporary);
    if (file < 0) refuse(path, errno);
    int reason = write_and_flush(file, bytes) ? 0 : errno;
    if (::close(file) != 0 && reason == 0) reason = errno;
    if (reason == 0 && std::rename(temporary.c_str(), path.c_str()) != 0) reason = errno;
    if (reason == 0) return flush_folder_of(path);
    ::unlink(temporary.c_str());
    refuse(path, reason);
}

}  // namespace pbs

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
#include <utility>

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

// The new name survives a loss of power, too. File systems that cannot flush a folder keep no such promise.
void flush_folder_of(const std::string& path)
{
    const std::filesystem::path parent = std::filesystem::path(path).parent_path();
    const int folder = ::open(parent.empty() ? "." : parent.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder < 0) return;
    ::fsync(folder);
    ::close(folder);
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

AtomicFile::AtomicFile(const std::string& path) : path_(path)
{
    require_no_device(path);
    file_ = open_new(beginning_of_temporary(path), temporary_);
    if (file_ < 0) refuse(errno);
}

AtomicFile::~AtomicFile()
{
    if (file_ >= 0) ::close(file_);
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void AtomicFile::write(std::string_view bytes)
{
    while (!bytes.empty()) {
        const ssize_t count = ::write(file_, bytes.data(), bytes.size());
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) refuse(errno);
        bytes.remove_prefix(static_cast<std::size_t>(count));
    }
}

void AtomicFile::finish()
{
    if (::fsync(file_) != 0) refuse(errno);  // a full disk may say so no earlier
    if (::close(std::exchange(file_, -1)) != 0 || std::rename(temporary_.c_str(), path_.c_str()) != 0) refuse(errno);
    temporary_.clear();
    flush_folder_of(path_);
}

void AtomicFile::refuse(int reason) const
{
    throw InputError(path_, 0, "", "", "cannot be written: " + std::generic_category().message(reason));
}

void write_atomically(const std::string& path, const std::string& bytes)
{
    AtomicFile file(path);
    file.write(bytes);
    file.finish();
}

}  // namespace pbs

#include "pbs/geometry/text_file.hpp"

#include "pbs/geometry/input_error.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>

namespace pbs {
namespace {

// Opens for reading; the kind of a file is known only once it is open.
class OpenFile {
public:
    explicit OpenFile(const std::string& path) : path_(path), file_(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC))
    {
        if (file_ < 0) refuse("cannot be opened: " + std::generic_category().message(errno));
    }
    ~OpenFile() { ::close(file_); }
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;

    std::uintmax_t bytes() const
    {
        struct stat status = {};
        if (::fstat(file_, &status) != 0 || !S_ISREG(status.st_mode)) refuse("cannot be opened: expected a file");
        return static_cast<std::uintmax_t>(status.st_size);
    }

    // False at the end of the file.
    bool append_to(std::string& text) const
    {
        std::array<char, 1 << 16> buffer;
        const ssize_t count = ::read(file_, buffer.data(), buffer.size());
        if (count < 0 && errno != EINTR) refuse("cannot be read: " + std::generic_category().message(errno));
        if (count > 0) text.append(buffer.data(), static_cast<std::size_t>(count));
        return count != 0;
    }

private:
    [[noreturn]] void refuse(const std::string& rule) const { throw InputError(path_, 0, "", "", rule); }

    std::string path_;
    int file_;
};

}  // namespace

void require_size(const std::string& path, std::uintmax_t bytes, std::uintmax_t most_bytes)
{
    if (bytes > most_bytes) throw InputError(path, 0, "bytes", std::to_string(bytes), "expected at most " + std::to_string(most_bytes));
}

std::string read_text_file(const std::string& path, std::uintmax_t most_bytes)
{
    const OpenFile file(path);
    require_size(path, file.bytes(), most_bytes);
    std::string text;
    while (file.append_to(text)) require_size(path, text.size(), most_bytes);  // it may grow
    return text;
}

}  // namespace pbs

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

// Open for reading; what a name stands for is known only once it is open.
class OpenFile {
public:
    explicit OpenFile(const std::string& path) : path_(path), file_(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC))
    {
        if (file_ < 0) refuse("cannot be opened: " + std::generic_category().message(errno));
    }
    ~OpenFile() { ::close(file_); }
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;

    void require_regular() const
    {
        struct stat status = {};
        if (::fstat(file_, &status) != 0 || !S_ISREG(status.st_mode)) refuse("cannot be opened: expected a file");
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

std::string read_text_file(const std::string& path)
{
    const OpenFile file(path);
    file.require_regular();
    std::string text;
    while (file.append_to(text)) {
    }
    return text;
}

}  // namespace pbs

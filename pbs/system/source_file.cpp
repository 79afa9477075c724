#include "pbs/system/source_file.hpp"

#include "pbs/geometry/input_error.hpp"

#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <ctime>
#include <filesystem>
#include <map>
#include <mutex>
#include <set>
#include <system_error>
#include <tuple>
#include <utility>

namespace pbs {
namespace {

constexpr double clock_tick_s =
    0.05;  // of the file system, far above the 10 ms of slow clocks: changes within one have the same time

double seconds_of(const timespec& time)
{
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

std::string words_of(int reason)
{
    return std::generic_category().message(reason);
}

}  // namespace

struct SourceFile::Content {
    std::mutex mutex;
    OpenFile file{-1};
    struct stat status = {};  // when it was opened
    int reason = 0;           // why it was not
    std::string bytes = {};
    bool is_opened = false, is_whole = false;
    bool is_settled = false;  // its time of change would show a later change
    std::set<std::string> safe_readers = {};

    // The kind of a file is known only once it is open.
    bool open(const std::string& path)
    {
        if (!std::exchange(is_opened, true)) {
            file.number = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
            reason = file.number < 0 ? errno : 0;
            timespec now = {};
            ::clock_gettime(CLOCK_REALTIME, &now);
            if (file.number >= 0) ::fstat(file.number, &status);
            is_settled = seconds_of(now) - seconds_of(status.st_ctim) > clock_tick_s;
        }
        return S_ISREG(status.st_mode);
    }

    bool is_in_its_place(const std::string& path) const
    {
        struct stat now = {};
        const auto identity = [](const struct stat& file_status) {
            return std::tuple(file_status.st_dev, file_status.st_ino, file_status.st_size, file_status.st_ctim.tv_sec,
                              file_status.st_ctim.tv_nsec);
        };
        return ::stat(path.c_str(), &now) == 0 && identity(now) == identity(status);
    }
};

SourceFile::SourceFile(const std::string& path) : path_(path)
{
    static std::mutex mutex;
    static std::map<std::string, std::weak_ptr<Content>> contents;  // by the path with links followed
    std::error_code code;
    const std::filesystem::path canonical = std::filesystem::canonical(path, code);
    const std::lock_guard lock(mutex);
    std::erase_if(contents, [](const auto& entry) { return entry.second.expired(); });
    std::weak_ptr<Content>& known = contents[code ? path : canonical.string()];
    content_ = known.lock();
    if (content_) {
        const std::lock_guard content_lock(content_->mutex);
        if (!content_->is_opened || (content_->is_settled && content_->is_in_its_place(path))) return;
    }
    content_ = std::make_shared<Content>();
    known = content_;
}

const std::string& SourceFile::text(std::uintmax_t most_bytes) const
{
    const auto refuse = [&](const std::string& rule) { throw InputError(path_, 0, "", "", rule); };
    const std::lock_guard lock(content_->mutex);
    std::string& bytes = content_->bytes;
    if (!content_->open(path_))
        refuse("cannot be opened: " + (content_->reason ? words_of(content_->reason) : "expected a file"));
    require_size(path_, std::max(static_cast<std::uintmax_t>(content_->status.st_size), std::uintmax_t(bytes.size())),
                 most_bytes);
    std::array<char, 1 << 16> buffer;
    for (ssize_t count = 1; count != 0 && !content_->is_whole;) {
        count = ::pread(content_->file.number, buffer.data(), buffer.size(), static_cast<off_t>(bytes.size()));
        if (count < 0 && errno != EINTR) refuse("cannot be read: " + words_of(errno));
        if (count > 0) bytes.append(buffer.data(), static_cast<std::size_t>(count));
        require_size(path_, bytes.size(), most_bytes);  // it may grow
    }
    if (!std::exchange(content_->is_whole, true)) ::close(std::exchange(content_->file.number, -1));
    return bytes;
}

std::string SourceFile::beginning() const
{
    constexpr std::size_t most_bytes = 4096;
    const std::lock_guard lock(content_->mutex);
    if (content_->is_whole) return content_->bytes.substr(0, most_bytes);
    if (!content_->open(path_)) return "";
    std::string beginning(most_bytes, '\0');
    const ssize_t count = ::pread(content_->file.number, beginning.data(), beginning.size(), 0);
    beginning.resize(static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
    return beginning;
}

bool SourceFile::was_changed() const
{
    const bool has_later_time = [&] {
        const std::lock_guard lock(content_->mutex);
        return !content_->is_in_its_place(path_);
    }();
    if (has_later_time || content_->is_settled || !content_->is_whole) return has_later_time;
    return SourceFile(path_).text() != content_->bytes;  // which opens it again
}

bool SourceFile::is_safe_for(const std::string& reader) const
{
    const std::lock_guard lock(content_->mutex);
    return content_->is_whole && content_->safe_readers.contains(reader);
}

void SourceFile::set_safe_for(const std::string& reader) const
{
    const std::lock_guard lock(content_->mutex);
    if (content_->is_whole) content_->safe_readers.insert(reader);
}

}  // namespace pbs

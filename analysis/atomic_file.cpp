#include "analysis/atomic_file.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/process.hpp"
#include "pbs/geometry/text_file.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <regex>
#include <string>
#include <system_error>
#include <vector>

namespace analysis {
namespace {

namespace fs = std::filesystem;

// .NAME.PROCESS.RANDOM beside the file; pbs::write_atomically writes .NAME.PROCESS.EXTENSION.
const std::regex temporary_name(R"(\..+\.([0-9]{1,9})\.([A-Za-z0-9]{6}|vtu|vtp|pvd|msh|mesh))");

std::string temporary_beside(const std::string& path)
{
    const fs::path target(path);
    return (target.parent_path() / fmt::format(".{}.{}.XXXXXX", target.filename().string(), ::getpid())).string();
}

bool is_abandoned(const fs::path& file)
{
    std::smatch match;
    const std::string name = file.filename().string();
    return std::regex_match(name, match, temporary_name) && pbs::process_is_gone(std::stoi(match[1]));
}

bool write_all(int file, const std::string& text)
{
    std::size_t done = 0;
    while (done < text.size()) {
        const ssize_t count = ::write(file, text.data() + done, text.size() - done);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return false;
        done += static_cast<std::size_t>(count);
    }
    return true;
}

// mkstemp keeps its files private; records get the permissions that any new file would.
bool give_usual_permissions(int file)
{
    const mode_t mask = ::umask(0);
    ::umask(mask);
    return ::fchmod(file, 0666 & ~mask) == 0;
}

[[noreturn]] void refuse(const std::string& path, int reason)
{
    throw pbs::InputError(path, 0, "", "", "cannot be written: " + std::generic_category().message(reason));
}

}  // namespace

void write_text_atomically(const std::string& path, const std::string& text)
{
    std::string temporary = temporary_beside(path);
    const int file = ::mkstemp(temporary.data());
    if (file < 0) refuse(path, errno);
    int reason = write_all(file, text) && give_usual_permissions(file) && ::fsync(file) == 0 ? 0 : errno;
    if (::close(file) != 0 && reason == 0) reason = errno;
    if (reason == 0 && std::rename(temporary.c_str(), path.c_str()) != 0) reason = errno;
    if (reason != 0) {
        ::unlink(temporary.c_str());
        refuse(path, reason);
    }
}

void remove_abandoned_files(const std::string& folder, bool and_below)
{
    std::error_code ignored;
    std::vector<fs::path> abandoned;
    for (fs::recursive_directory_iterator entry(folder, ignored), end; entry != end; entry.increment(ignored)) {
        if (!and_below) entry.disable_recursion_pending();
        if (entry->is_regular_file(ignored) && is_abandoned(entry->path())) abandoned.push_back(entry->path());
    }
    for (const fs::path& file : abandoned) fs::remove(file, ignored);
}

std::string read_text(const std::string& path)
{
    return pbs::read_text_file(path);
}

}  // namespace analysis

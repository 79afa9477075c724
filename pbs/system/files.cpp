#include "pbs/system/files.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/system/source_file.hpp"

#include <fcntl.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <random>
#include <system_error>
#include <utility>
#include <vector>

namespace pbs {
namespace {

constexpr int most_parts = 64;

// Behind the text in quotes that begins at `place`; one that is not closed ends with its line, or with the file where
// it may have many.
std::size_t after_quotes(const std::string& text, std::size_t place)
{
    const char quote = text[place];
    const std::string three(3, quote);
    const bool many_lines = text.compare(place, 3, three) == 0;
    for (std::size_t at = place + (many_lines ? 3 : 1); at < text.size(); ++at) {
        if (!many_lines && text[at] == '\n') return at;
        if (!many_lines && text[at] == quote) return at + 1;
        // two more belong to the text
        if (text.compare(at, 3, three) == 0) return std::min(text.find_first_not_of(quote, at), at + 5);
        if (text[at] == '\\' && quote == '"') ++at;
    }
    return text.size();
}

[[noreturn]] void refuse(const std::string& text, std::size_t place, const std::string& file, const std::string& field,
                         const std::string& value, const std::string& rule)
{
    throw InputError(file, line_at(text, place), field, value, rule);
}

std::string beginning_of_line(const std::string& text, std::size_t place)
{
    const std::size_t before = place == 0 ? std::string::npos : text.rfind('\n', place - 1);
    return text.substr(before == std::string::npos ? 0 : before + 1, 40) + "...";
}

bool is_within_a_word(char before)
{
    return std::isalnum(static_cast<unsigned char>(before)) ||
           std::string_view("_-+\"'").find(before) != std::string_view::npos;
}

constexpr std::size_t most_name_bytes =
    200;  // of NAME: with what is added it stays below the 255 that a file system allows

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

// The names of the first files that are being written; a signal handler may read them at any time.
std::array<std::atomic<const char*>, 64> unfinished = {};

void exchange_unfinished(const char* name, const char* by)
{
    for (auto& entry : unfinished)
        if (const char* expected = name; entry.compare_exchange_strong(expected, by)) return;
}

// Like mkstemp(3), with the permissions of any new file: an existing entry, such as a link, is not opened. The name is
// among the unfinished ones before the file exists, since a signal may come before open() returns.
int open_new(const std::string& beginning, std::string& name)
{
    for (int tries = 0; tries < 100; ++tries) {
        name = beginning + random_letters(6);
        exchange_unfinished(nullptr, name.c_str());
        const int file = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (file >= 0) return file;
        exchange_unfinished(name.c_str(), nullptr);
        if (errno != EEXIST) return -1;
    }
    return -1;
}

// The new name survives a loss of power, too. File systems that cannot flush a folder keep no such promise.
void flush_folder_of(const std::string& path)
{
    const std::filesystem::path parent = std::filesystem::path(path).parent_path();
    const OpenFile folder{::open(parent.empty() ? "." : parent.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)};
    if (folder.number >= 0) ::fsync(folder.number);
}

}  // namespace

void require_size(const std::string& path, std::uintmax_t bytes, std::uintmax_t most_bytes)
{
    if (bytes > most_bytes)
        throw InputError(path, 0, "bytes", std::to_string(bytes), "expected at most " + std::to_string(most_bytes));
}

std::string read_text_file(const std::string& path, std::uintmax_t most_bytes)
{
    return SourceFile(path).text(most_bytes);
}

void check_toml_keys(const std::string& text, const std::string& file)
{
    // Dots of the keys that lead to a place of the text, and to the inline tables around it. Dots of numbers are
    // counted with the key before them.
    int dots = 0;
    std::vector<int> around = {0};
    // behind a byte-order mark
    for (std::size_t place = text.starts_with("\xef\xbb\xbf") ? 3 : 0; place < text.size();) {
        const char c = text[place];
        if (c == '"' || c == '\'') {
            // the parser goes on with its word, whatever letters the text has
            if (place > 0 && is_within_a_word(text[place - 1]))
                refuse(text, place, file, "quote", beginning_of_line(text, place),
                       "expected a text apart from what is before it");
            place = after_quotes(text, place);
        } else if (c == '#') {
            place = std::min(text.find('\n', place), text.size());
        } else {
            if ((c < ' ' && c != '\t' && c != '\r' && c != '\n') || c > '~')  // TOML's bare words are ASCII
                refuse(text, place, file, "byte", std::to_string(static_cast<unsigned char>(c)),
                       "expected ASCII outside of texts");
            if (c == '{') around.push_back(dots);
            if (c == '}' && around.size() > 1) around.pop_back();
            if (std::string_view("{},\n").find(c) != std::string_view::npos) dots = around.back();
            if ((dots += c == '.') >= most_parts)
                refuse(text, place, file, "key", beginning_of_line(text, place),
                       "nested too deep: expected at most 64 parts");
            ++place;
        }
    }
}

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
    exchange_unfinished(temporary_.c_str(), nullptr);
}

void AtomicFile::remove_unfinished()
{
    for (const auto& entry : unfinished)
        if (const char* name = entry.load()) ::unlink(name);
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
    exchange_unfinished(temporary_.c_str(), nullptr);
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

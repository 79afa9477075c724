#include "experiments/process/terminal.hpp"

#include "analysis/records/record_files.hpp"
#include "pbs/geometry/child_process.hpp"
#include "pbs/geometry/files.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>
#include <sys/ioctl.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <map>
#include <mutex>
#include <new>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace experiments {
namespace {

volatile std::sig_atomic_t signalled = 0, taken = 0;
bool progress_is_hidden = false;

// The work that is interrupted has the time of grace to end by itself: a step between two frames, and the tables of the frames before it.
constexpr double grace_s = 0.7, long_stage_s = 2.0;
constexpr char last_words[] = "interrupted; what was finished is kept";

// The stages of the program itself. A worker counts none. Signal handlers read these variables.
std::atomic<pid_t> watching = 0;
std::atomic<int> stages = 0, line_length = 0;  // 0: the line of the innermost stage has been printed
char line_of_stage[800];

void ring_after(double seconds)
{
    const auto whole = static_cast<time_t>(seconds);
    const itimerval once{{0, 0}, {whole, static_cast<suseconds_t>(1e6 * (seconds - static_cast<double>(whole)))}};
    setitimer(ITIMER_REAL, &once, nullptr);
}

void print_from_handler(const char* text, std::size_t length)
{
    if (::write(STDERR_FILENO, text, length) < 0) return;  // nobody reads it
}

// The second signal ends the program at once, and its workers with it. A worker goes on, because a signal to its whole group reaches it
// twice: directly, and from its parent. It has the time of grace from the first one, in a stage or not.
void on_signal(int signal)
{
    const bool is_second = signalled != 0, is_program = getpid() == watching;
    signalled = 1;
    if (is_program && is_second) {
        std::signal(signal, SIG_DFL);
        std::raise(signal);  // which waits for the end of this handler
    } else if (!is_second && (stages > 0 || !is_program)) {
        ring_after(grace_s);
    }
}

void on_alarm(int)
{
    const int error = errno;
    if (interrupted()) {
        pbs::AtomicFile::remove_unfinished();
        if (getpid() == watching)
            for (const char* text : {"pbskin: ", last_words, "\n"}) print_from_handler(text, std::strlen(text));
        _exit(exit_interrupted);
    }
    ring_after(long_stage_s);
    if (interrupted()) ring_after(grace_s);  // a signal came after the first line
    if (const int length = line_length.exchange(0); length > 0) print_from_handler(line_of_stage, static_cast<std::size_t>(length));
    errno = error;
}

void begin_stage(const std::string& name)
{
    stop_if_interrupted();
    if (getpid() != watching) return;
    if (stages++ == 0) ring_after(long_stage_s);
    line_length = 0;
    const auto line = fmt::format_to_n(line_of_stage, sizeof line_of_stage, "{:.190} ...\n", name);  // a character has at most 4 bytes
    if (!progress_is_hidden) line_length = static_cast<int>(line.size);
}

void end_stage()
{
    if (getpid() != watching || --stages > 0) return;
    line_length = 0;
    ring_after(0.0);
}

constexpr int bar_width = 30;
constexpr double redraw_s = 0.1;

// Messages of libraries may have several paragraphs.
std::string on_one_line(const std::string& text)
{
    std::istringstream words(text);
    std::string line;
    for (std::string word; words >> word;) line += (line.empty() ? "" : " ") + word;
    return line;
}

}  // namespace

std::string Failure::message() const
{
    return status == exit_internal ? "internal error: " + on_one_line(words) + "; please report it with the command line" : words;
}

Failure caught_failure()
{
    try {
        throw;
    } catch (const pbs::InputError& error) {
        return {error.what(), exit_input};
    } catch (const Interrupted&) {
        return {last_words, exit_interrupted};
    } catch (const std::filesystem::filesystem_error& error) {
        return {pbs::InputError(error.path1().string(), 0, "", "", error.code().message()).what(), exit_input};
    } catch (const std::bad_alloc&) {
        return {"not enough memory for this task", exit_input};
    } catch (const std::exception& error) {
        return {error.what(), exit_internal};
    } catch (...) {
        return {"an exception without a message", exit_internal};
    }
}

void watch_interrupts()
{
    watching = getpid();
    struct sigaction action = {};
    action.sa_handler = on_signal;
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    action.sa_handler = on_alarm;
    action.sa_flags = SA_RESTART;  // work goes on as if nothing had happened
    sigaction(SIGALRM, &action, nullptr);
    pbs::stage_watcher = {begin_stage, end_stage};
    pbs::ask_while_reading(stop_if_interrupted);
    std::signal(SIGXFSZ, SIG_IGN);  // then a file over the limit (ulimit -f) is a write error, as on a full disk
}

bool interrupted()
{
    return signalled != 0 && taken == 0;
}

bool take_interruption()
{
    if (!interrupted()) return false;
    taken = 1;
    ring_after(stages > 0 ? long_stage_s : 0.0);
    return true;
}

void stop_if_interrupted()
{
    if (!interrupted()) return;
    ring_after(0.0);  // from here on, the work ends by itself
    throw Interrupted{};
}

std::size_t terminal_width()
{
    std::size_t width = 0;
    if (const char* columns = std::getenv("COLUMNS")) std::from_chars(columns, columns + std::strlen(columns), width);
    if (width > 0) return width;
    winsize size{};
    if (isatty(STDOUT_FILENO) && ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
    return 100;
}

bool terminal_has_colours()
{
    if (std::getenv("NO_COLOR")) return false;
    const char* forced = std::getenv("CLICOLOR_FORCE");
    return forced ? std::strcmp(forced, "0") != 0 : isatty(STDOUT_FILENO) != 0;
}

void hide_progress()
{
    progress_is_hidden = true;
}

void show_progress()
{
    progress_is_hidden = false;
}

Progress::Progress(std::string label, int total)
    : label_(std::move(label)), total_(total), shown_(!progress_is_hidden && isatty(STDERR_FILENO) && total > 0)
{
}

Progress::~Progress()
{
    if (shown_) std::fputs("\r\033[K", stderr);
}

void Progress::advance_to(int done)
{
    if (done > 0) advance_to(done, fmt::format("{:.0f} s left", stopwatch_.seconds() / done * (total_ - done)));
}

void Progress::advance_to(int done, const std::string& words)
{
    const double elapsed = stopwatch_.seconds();
    if (!shown_ || (elapsed - last_drawn_s_ < redraw_s && done < total_)) return;
    last_drawn_s_ = elapsed;
    const int filled = bar_width * done / total_;
    fmt::print(stderr, "\r\033[K{} [{:#<{}}{:.<{}}] {}/{} {}", label_, "", filled, "", bar_width - filled, done, total_, words);
    std::fflush(stderr);
}

void warn(const std::vector<std::string>& remarks)
{
    for (const std::string& remark : remarks) spdlog::warn("pbskin: warning: {}", remark);
}

// Passes on everything except warnings, each of which becomes one line of the file. The processes append to it in turn. A run without
// warnings has no file, also if it is killed.
class CollectedWarnings::Sink : public spdlog::sinks::base_sink<std::mutex> {
public:
    Sink(std::string file, std::vector<spdlog::sink_ptr> others) : others(std::move(others)), file_(std::move(file)) {}

    void add(const std::string& text)
    {
        std::string line = text;
        std::ranges::replace(line, '\n', ' ');
        line += '\n';
        const int opened = ::open(file_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
        const bool is_written = opened >= 0 && ::write(opened, line.data(), line.size()) == static_cast<ssize_t>(line.size());
        if (opened >= 0) ::close(opened);
        if (!is_written) throw pbs::InputError(file_, 0, "", "", fmt::format("cannot be written: {}", std::strerror(errno)));
    }

    std::vector<spdlog::sink_ptr> others;

protected:
    void sink_it_(const spdlog::details::log_msg& message) override
    {
        if (message.level == spdlog::level::warn) return add({message.payload.data(), message.payload.size()});
        for (const spdlog::sink_ptr& other : others) other->log(message);
    }
    void flush_() override
    {
        for (const spdlog::sink_ptr& other : others) other->flush();
    }

private:
    std::string file_;
};

CollectedWarnings::CollectedWarnings(const std::string& file) : file_(file)
{
    analysis::require_writable(file);
    analysis::remove_record(file);
    std::vector<spdlog::sink_ptr>& sinks = spdlog::default_logger()->sinks();
    sink_ = std::make_shared<Sink>(file, sinks);
    sinks = {sink_};
}

// Work that ends before its summary leaves the warnings of until then.
CollectedWarnings::~CollectedWarnings()
{
    spdlog::default_logger()->sinks() = sink_->others;
    try {
        summary();
    } catch (const std::exception&) {  // such as a full disk, which has been reported
        std::error_code ignored;
        std::filesystem::remove(file_, ignored);
    }
}

void CollectedWarnings::add(const std::string& text)
{
    sink_->add(text);
}

std::string CollectedWarnings::summary()
{
    if (std::exchange(is_summed_up_, true) || !std::filesystem::exists(file_)) return "";
    std::istringstream lines(analysis::read_text(file_));
    std::map<std::string, int> counts;
    for (std::string line; std::getline(lines, line);) ++counts[line];
    std::string text;
    for (const auto& [line, count] : counts) text += count > 1 ? fmt::format("{} ({} times)\n", line, count) : line + "\n";
    analysis::write_text_atomically(file_, text);
    return fmt::format("Warnings: {}, in {}\n", counts.size(), file_);
}

}  // namespace experiments

#include "experiments/process/terminal.hpp"

#include "analysis/records/record_files.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/system/child_process.hpp"
#include "pbs/system/files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <list>
#include <map>
#include <mutex>
#include <new>
#include <sstream>
#include <stdexcept>
#include <stop_token>
#include <thread>
#include <utility>

namespace experiments {
namespace {

std::atomic<bool> progress_is_hidden = false;

constexpr char last_words[] = "interrupted; what was finished is kept";

// The signal handler reads these variables.
std::atomic<pid_t> program = 0;  // the process that says that it was interrupted; its children say nothing
std::atomic<pid_t> noting = 0;   // the process in which the next signal is only noted; 0: none
std::atomic<bool> signalled = false;
std::atomic<const char*> unsaid = "";

// A child that notes signals goes on noting them, since a signal to its whole group reaches it twice: directly, and
// from its parent.
void on_signal(int)
{
    if (noting == getpid()) {
        if (getpid() == program) noting = 0;
        signalled = true;
        return;
    }
    pbs::AtomicFile::remove_unfinished();
    if (getpid() == program)
        for (const char* text :
             {isatty(STDERR_FILENO) != 0 ? "\r\033[K" : "", unsaid.load(), "pbskin: ", last_words, "\n"})
            if (::write(STDERR_FILENO, text, std::strlen(text)) < 0) break;  // nobody reads it
    _exit(exit_interrupted);
}

// Prints the name of the innermost stage when the stages around it have taken so long, and again so much later.
class StageNames {
public:
    void begin(const std::string& name)
    {
        const std::lock_guard lock(mutex_);
        unprinted_ = name;
        if (++stages_ > 1) return;
        sigset_t all, before;  // the thread of the program handles them
        sigfillset(&all);
        pthread_sigmask(SIG_SETMASK, &all, &before);
        watch_ = std::jthread([this](const std::stop_token& stop) { print_in_time(stop); });
        pthread_sigmask(SIG_SETMASK, &before, nullptr);
    }

    void end()
    {
        {
            const std::lock_guard lock(mutex_);
            unprinted_.clear();
            if (--stages_ > 0) return;
        }
        watch_ = {};
    }

private:
    void print_in_time(const std::stop_token& stop)
    {
        constexpr auto long_stage = std::chrono::seconds(2);
        std::unique_lock lock(mutex_);
        while (!stop.stop_requested()) {
            ended_.wait_for(lock, stop, long_stage, [] { return false; });
            if (stop.stop_requested() || progress_is_hidden || unprinted_.empty()) continue;
            fmt::print(stderr, "{} ...\n", std::exchange(unprinted_, ""));
        }
    }

    std::mutex mutex_;
    std::condition_variable_any ended_;
    int stages_ = 0;
    std::string unprinted_;
    std::jthread watch_;
};

// It is never destroyed: a reader that calls exit() in a child, which has not this thread, would wait for it.
StageNames& stage_names = *new StageNames;

// Only the program itself names its stages.
void begin_stage(const std::string& name)
{
    if (getpid() == program) stage_names.begin(name);
}

void end_stage()
{
    if (getpid() == program) stage_names.end();
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
    return status == exit_internal
               ? "internal error: " + on_one_line(words) + "; please report it with the command line"
               : words;
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
    program = getpid();
    struct sigaction action = {};
    action.sa_handler = on_signal;
    action.sa_flags = SA_RESTART;  // work goes on as if nothing had happened
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    pbs::stage_watcher = {begin_stage, end_stage};
    std::signal(SIGXFSZ, SIG_IGN);  // then a file over the limit (ulimit -f) is a write error, as on a full disk
}

NotedInterrupts::NotedInterrupts() : around_(noting.exchange(getpid()))
{
}

NotedInterrupts::~NotedInterrupts()
{
    pid_t self = getpid();
    noting.compare_exchange_strong(self, around_);  // not after a signal: the next one ends the process
}

bool interrupted()
{
    return signalled;
}

void say_when_interrupted(const std::string& text)
{
    static std::list<std::string> texts;  // all of them, since the handler may be reading one
    unsaid = texts.emplace_back(text).c_str();
}

bool take_interruption()
{
    const bool taken = signalled.exchange(false);
    if (taken && getpid() == program)
        spdlog::info("interrupted; what is finished is written now (a second interruption ends this too)");
    return taken;
}

void stop_if_interrupted()
{
    if (interrupted()) throw Interrupted{};
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
    fmt::print(stderr, "\r\033[K{} [{:#<{}}{:.<{}}] {}/{} {}", label_, "", filled, "", bar_width - filled, done, total_,
               words);
    std::fflush(stderr);
}

void warn(const std::vector<std::string>& remarks)
{
    for (const std::string& remark : remarks) spdlog::warn("pbskin: warning: {}", remark);
}

// Passes on everything except warnings, each of which becomes one line of the file. The processes append to it in turn.
// A run without warnings has no file, also if it is killed.
class CollectedWarnings::Sink : public spdlog::sinks::base_sink<std::mutex> {
public:
    Sink(std::string file, std::vector<spdlog::sink_ptr> others) : others(std::move(others)), file_(std::move(file)) {}

    void add(const std::string& text)
    {
        std::string line = text;
        std::ranges::replace(line, '\n', ' ');
        line += '\n';
        const int opened = ::open(file_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
        const bool is_written =
            opened >= 0 && ::write(opened, line.data(), line.size()) == static_cast<ssize_t>(line.size());
        if (opened >= 0) ::close(opened);
        if (!is_written)
            throw pbs::InputError(file_, 0, "", "", fmt::format("cannot be written: {}", std::strerror(errno)));
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
    for (const auto& [line, count] : counts)
        text += count > 1 ? fmt::format("{} ({} times)\n", line, count) : line + "\n";
    analysis::write_text_atomically(file_, text);
    return fmt::format("Warnings: {}, in {}\n", counts.size(), file_);
}

}  // namespace experiments

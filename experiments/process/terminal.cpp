#include "experiments/process/terminal.hpp"

#include "pbs/geometry/child_process.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <new>
#include <sstream>

namespace experiments {
namespace {

volatile std::sig_atomic_t signalled = 0;

void on_signal(int)
{
    signalled = 1;
}

bool progress_is_hidden = false;
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
        return {"interrupted; what was finished is kept", exit_interrupted};
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
    struct sigaction action = {};
    action.sa_handler = on_signal;
    action.sa_flags = SA_RESETHAND;  // the second signal ends the program at once
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    pbs::ask_while_reading(stop_if_interrupted);
    std::signal(SIGXFSZ, SIG_IGN);  // then a file over the limit (ulimit -f) is a write error, as on a full disk
}

bool interrupted()
{
    return signalled != 0;
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
    const double elapsed = stopwatch_.seconds();
    if (!shown_ || done == 0 || (elapsed - last_drawn_s_ < redraw_s && done < total_)) return;
    last_drawn_s_ = elapsed;
    const int filled = bar_width * done / total_;
    const double left_s = elapsed / done * (total_ - done);
    fmt::print(stderr, "\r\033[K{} [{:#<{}}{:.<{}}] {}/{} {:.0f} s left", label_, "", filled, "", bar_width - filled, done, total_, left_s);
    std::fflush(stderr);
}

void warn(const std::vector<std::string>& remarks)
{
    for (const std::string& remark : remarks) spdlog::warn("pbskin: warning: {}", remark);
}

}  // namespace experiments

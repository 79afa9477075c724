#include "experiments/process/progress.hpp"

#include <fmt/format.h>

#include <unistd.h>

#include <cstdio>

namespace experiments {
namespace {

bool hidden = false;
constexpr int bar_width = 30;
constexpr double redraw_s = 0.1;

}  // namespace

void hide_progress()
{
    hidden = true;
}

void show_progress()
{
    hidden = false;
}

Progress::Progress(std::string label, int total)
    : label_(std::move(label)), total_(total), shown_(!hidden && isatty(STDERR_FILENO) && total > 0)
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

}  // namespace experiments

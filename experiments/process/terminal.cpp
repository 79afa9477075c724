#include "experiments/process/terminal.hpp"

#include <charconv>
#include <cstdlib>
#include <cstring>

#include <sys/ioctl.h>
#include <unistd.h>

namespace experiments {

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

}  // namespace experiments

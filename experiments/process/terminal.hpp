// The terminal that standard output goes to.
#pragma once

#include <cstddef>

namespace experiments {

// The number of characters in a line: COLUMNS, else the width of the terminal, else 100.
std::size_t terminal_width();

// False if NO_COLOR is set. Otherwise CLICOLOR_FORCE decides (any value except 0: true), and if that is not set, whether standard output is
// a terminal.
bool terminal_has_colours();

}  // namespace experiments

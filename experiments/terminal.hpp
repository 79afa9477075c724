// The terminal that standard output goes to.
#pragma once

#include <cstddef>

namespace experiments {

// Characters in a line: COLUMNS, else what the terminal says, else 100.
std::size_t terminal_width();

bool terminal_has_colours();  // a terminal, and NO_COLOR is not set

}  // namespace experiments

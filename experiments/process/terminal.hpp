// The terminal that standard output goes to.
#pragma once

#include <cstddef>

namespace experiments {

// Characters in a line: COLUMNS, else what the terminal says, else 100.
std::size_t terminal_width();

// NO_COLOR is not set, and CLICOLOR_FORCE says so (any value but 0: yes, where the caller shows on a terminal what it reads here), or,
// where that is not set either, it is a terminal.
bool terminal_has_colours();

}  // namespace experiments

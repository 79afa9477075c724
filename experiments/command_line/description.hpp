// The command line in words a program reads: the manual page and the shells' completions are written from it.
//   pbskin --describe
#pragma once

#include <CLI/CLI.hpp>

#include <string>

namespace experiments {

// JSON: name, meaning, options, and verbs with theirs. An option has names (none: positional), name, meaning, value (empty: a flag),
// choices (empty: anything), repeated, required. What has no group is hidden and left out.
std::string describe(const CLI::App& app);

}  // namespace experiments

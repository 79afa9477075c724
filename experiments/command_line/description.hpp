// The command line and the scene keys as JSON, from which the manual pages, the scene manual and the shells' completions are written.
//   pbskin --describe
#pragma once

#include <CLI/CLI.hpp>

#include <string>

namespace experiments {

// Returns JSON: name, meaning, options, verbs with their options, and scene_keys. An option has names (none: positional), name, meaning,
// value (empty: a flag), choices (empty: anything), repeated, required. Options without a group are hidden and left out.
// A scene key has table, name, meaning, unit, rule and default (JSON text; empty: every scene states it).
std::string describe(const CLI::App& app);

}  // namespace experiments

// The skeleton TOML: [[joint]] with name, parent ("" for a root), head_m, tail_m.
#pragma once

#include "pbs/skinning/pose.hpp"

#include <string>

namespace pbs {

// Coordinates in metres; bones come parents first, else in the file's order. InputError by line: no TOML; a key that is unknown, missing or
// of another type; a coordinate that is not finite or beyond 1e9 m; a name given twice or empty, a parent that is none (the nearest is
// named), a cycle; no root; a bone without length; no joint, or over 2,000; a file over 16 MiB. And in a build without PBS_WITH_RIG_IMPORT.
Skeleton read_skeleton(const std::string& path);
Skeleton parse_skeleton(const std::string& text, const std::string& name);  // `name` stands for the file in errors

}  // namespace pbs

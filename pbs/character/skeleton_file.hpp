// The skeleton TOML: [[joint]] with name, parent ("" for a root), head_m, tail_m.
#pragma once

#include "pbs/skinning/skeleton.hpp"

#include <string>

namespace pbs {

Skeleton read_skeleton(const std::string& path);
Skeleton parse_skeleton(const std::string& text, const std::string& name);  // `name` stands for the file in errors

}  // namespace pbs

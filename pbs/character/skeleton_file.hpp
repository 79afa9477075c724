// The skeleton TOML: [[joint]] with name, parent ("" for a root), head_m, tail_m. Weights: CSV vertex,joint,weight.
#pragma once

#include "pbs/skinning/weights.hpp"

namespace pbs {

Skeleton read_skeleton(const std::string& path);
Skeleton parse_skeleton(const std::string& text, const std::string& name);  // `name` stands for the file in errors
Weights read_weights(const std::string& path, const Skeleton& skeleton, int vertices);

}  // namespace pbs

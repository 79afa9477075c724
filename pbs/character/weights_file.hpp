// Skinning weights from a file: CSV vertex,joint,weight.
#pragma once

#include "pbs/skinning/weights.hpp"

#include <string>

namespace pbs {

Weights read_weights(const std::string& path, const Skeleton& skeleton, int vertices);

}  // namespace pbs

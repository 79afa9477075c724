// A text file whole: the one reader of scenes, skeletons, weights, clips and records.
#pragma once

#include "pbs/geometry/file_limits.hpp"

#include <string>

namespace pbs {

// An InputError where it cannot be read, is larger or is no file: a named pipe would be waited for without end, a device has none.
std::string read_text_file(const std::string& path, std::uintmax_t most_bytes = most_text_bytes);

}  // namespace pbs

// A text file whole: the one reader of scenes, skeletons, weights, clips and records.
#pragma once

#include <string>

namespace pbs {

// An InputError where it cannot be read or is no file: a named pipe would be waited for without end, a device has none.
std::string read_text_file(const std::string& path);

}  // namespace pbs

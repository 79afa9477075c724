// A text file whole: what the readers of skeletons, weights and clips share.
#pragma once

#include <string>

namespace pbs {

std::string read_text_file(const std::string& path);  // an InputError where it cannot be read

}  // namespace pbs

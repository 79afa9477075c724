// A text file whole, and the known name nearest to a mistyped one: what the readers of skeletons, weights and clips share.
#pragma once

#include <string>
#include <vector>

namespace pbs {

std::string read_text_file(const std::string& path);  // an InputError where it cannot be read

// The known name with the least edit distance (Levenshtein); empty where there are none.
std::string nearest_name(const std::string& name, const std::vector<std::string>& known);

}  // namespace pbs

// The known name nearest to a mistyped one, for errors.
//   throw InputError(file, line, key, "", "unknown key; the nearest known one is " + nearest_name(key, known));
#pragma once

#include <string>
#include <vector>

namespace pbs {

// The known name with the least edit distance (Levenshtein), the first of equals; empty where there are none.
std::string nearest_name(const std::string& name, const std::vector<std::string>& known);

}  // namespace pbs

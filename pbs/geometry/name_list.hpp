// The first few of many names, for messages.
//   name_list({"a", "b", "c", "d", "e", "f", "g", "h"})   "a, b, c, d, e, f and 2 others"
#pragma once

#include <string>
#include <vector>

namespace pbs {

// All names if there are at most six.
std::string name_list(const std::vector<std::string>& names);

}  // namespace pbs

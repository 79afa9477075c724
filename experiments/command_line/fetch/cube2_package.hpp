// Debian's package cube2-data (173 MB), which holds Frankie: installed by apt where this process may (root, or sudo without a password).
#pragma once

#include <string>

namespace experiments {

bool cube2_is_there();
std::string bring_cube2();  // returns his file

}  // namespace experiments

// What was accepted with a treatment, on stderr: `pbskin: warning: FILE: FIELD = VALUE: treatment`, but for --quiet.
#pragma once

#include <string>
#include <vector>

namespace experiments {

void warn(const std::vector<std::string>& remarks);

}  // namespace experiments

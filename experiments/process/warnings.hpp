// Warnings on stderr about input that was accepted after a treatment: `pbskin: warning: FILE: FIELD = VALUE: treatment`. --quiet hides
// them.
#pragma once

#include <string>
#include <vector>

namespace experiments {

void warn(const std::vector<std::string>& remarks);

}  // namespace experiments

// What --version prints: version, git revision, compiler.
#pragma once

#include <string>

namespace experiments {

std::string version_text();

}  // namespace experiments

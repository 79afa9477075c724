// The claims of claims.toml, which the program carries.
#pragma once

#include "analysis/claims.hpp"

namespace experiments {

const std::vector<analysis::Claim>& claims();
std::string describe_claim(const analysis::Claim& claim);  // a few lines for the terminal

}  // namespace experiments

// The claims of claims.toml, which the program carries.
#pragma once

#include "analysis/claims.hpp"

#include <string>
#include <utility>
#include <vector>

namespace experiments {

const std::vector<analysis::Claim>& claims();

// What is claimed, where it is measured and what is expected, for `explain`: label and text.
std::vector<std::pair<std::string, std::string>> claim_lines(const analysis::Claim& claim);

}  // namespace experiments

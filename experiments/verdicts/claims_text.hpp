// A claim in words, for the terminal.
#pragma once

#include "analysis/claims.hpp"

#include <string>
#include <utility>
#include <vector>

namespace experiments {

// What is claimed, where it is measured and what is expected, for `explain`: label and text.
std::vector<std::pair<std::string, std::string>> claim_lines(const analysis::Claim& claim);

}  // namespace experiments

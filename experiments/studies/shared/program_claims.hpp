// The claims of claims.toml, which the program carries.
#pragma once

#include "analysis/claims.hpp"

#include <string>
#include <vector>

namespace experiments {

const std::vector<analysis::Claim>& claims();

const analysis::Claim& claim_named(const std::string& id);  // std::logic_error for an id that claims.toml does not have

}  // namespace experiments

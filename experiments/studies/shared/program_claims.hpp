// The claims of claims.toml, which is compiled into the program.
#pragma once

#include "analysis/verdicts/claims.hpp"

#include <string>
#include <vector>

namespace experiments {

const std::vector<analysis::Claim>& claims();

const analysis::Claim& claim_named(const std::string& id);  // std::logic_error for an id that claims.toml does not contain

}  // namespace experiments

#include "experiments/studies/shared/program_claims.hpp"

#include "generated/claims_texts.hpp"

#include <algorithm>
#include <stdexcept>

namespace experiments {

const std::vector<analysis::Claim>& claims()
{
    static const std::vector<analysis::Claim> all = analysis::parse_claims(::claims::claims_toml, "claims.toml");
    return all;
}

const analysis::Claim& claim_named(const std::string& id)
{
    const auto found = std::find_if(claims().begin(), claims().end(), [&](const analysis::Claim& claim) { return claim.id == id; });
    if (found == claims().end()) throw std::logic_error("no claim " + id);
    return *found;
}

}  // namespace experiments

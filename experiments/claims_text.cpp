#include "experiments/claims_text.hpp"

#include "analysis/claims_report.hpp"
#include "generated/claims_texts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace experiments {

const std::vector<analysis::Claim>& claims()
{
    static const std::vector<analysis::Claim> all = analysis::parse_claims(::claims::claims_toml, "claims.toml");
    return all;
}

std::string describe_claim(const analysis::Claim& claim)
{
    return fmt::format("{} (claim)\n  claim    {} ({})\n  study    {}, some {:g} minutes\n  measured {} of {}{}\n  expected {}", claim.id,
                       claim.statement, claim.place, claim.study, claim.cost_minutes, fmt::join(claim.metrics, ", "), claim.deformer,
                       claim.iterations > 0 ? fmt::format(" at {} iterations", claim.iterations) : "", analysis::expected_text(claim));
}

}  // namespace experiments

#include "experiments/claims_text.hpp"

#include "analysis/claims_report.hpp"
#include "analysis/measurement.hpp"
#include "generated/claims_texts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace experiments {

const std::vector<analysis::Claim>& claims()
{
    static const std::vector<analysis::Claim> all = analysis::parse_claims(::claims::claims_toml, "claims.toml");
    return all;
}

namespace {

std::string measure_of(const analysis::Claim& claim)
{
    if (claim.rule == analysis::ClaimRule::untestable) return "  why not  " + claim.reason;
    if (claim.rule == analysis::ClaimRule::printed) return "  measured by the paper's own figures, each against what the others ask for";
    if (claim.rule != analysis::ClaimRule::measured)
        return fmt::format("  measured {} of {}{}\n  expected {}", fmt::join(claim.metrics, ", "), claim.deformer,
                           claim.iterations > 0 ? fmt::format(" at {} iterations", claim.iterations) : "", analysis::expected_text(claim));
    std::string text = "  measured, each figure's interval within its bound:";
    for (const std::string& quantity : claim.metrics)
        text += fmt::format("\n             {}: {}", quantity, analysis::bound_text(analysis::bound_of(claim, quantity)));
    for (const std::string& quantity : claim.beside) text += fmt::format("\n    beside   {}", quantity);
    return text;
}

}  // namespace

std::string describe_claim(const analysis::Claim& claim)
{
    return fmt::format("{} (claim)\n  claim    {} ({})\n  study    {}, some {:g} minutes\n{}", claim.id, claim.statement, claim.place,
                       claim.study, claim.cost_minutes, measure_of(claim));
}

}  // namespace experiments

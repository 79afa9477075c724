#include "experiments/verdicts/claims_text.hpp"

#include "analysis/claims_report.hpp"
#include "analysis/measurement.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace experiments {

namespace {

using Lines = std::vector<std::pair<std::string, std::string>>;

Lines measured_quantities(const analysis::Claim& claim)
{
    std::vector<std::string> quantities;
    for (const std::string& quantity : claim.metrics)
        quantities.push_back(fmt::format("{}: {}", quantity, analysis::bound_text(analysis::bound_of(claim, quantity))));
    return {{"expected", fmt::format("of each figure its interval within the bound:\n{}", fmt::join(quantities, "\n"))},
            {"beside", fmt::format("{}", fmt::join(claim.beside, "\n"))}};
}

Lines measure_of(const analysis::Claim& claim)
{
    switch (claim.rule) {
        case analysis::ClaimRule::untestable:
            return {{"why not", claim.reason}};
        case analysis::ClaimRule::printed:
            return {{"measured", "the paper's own figures, each against what its others ask for"}};
        case analysis::ClaimRule::measured:
            return measured_quantities(claim);
        default:
            break;
    }
    const std::string iterations = claim.iterations > 0 ? fmt::format(" at {} iterations", claim.iterations) : "";
    return {{"measured", fmt::format("{} of {}{}", fmt::join(claim.metrics, ", "), claim.deformer, iterations)},
            {"expected", analysis::expected_text(claim)}};
}

}  // namespace

Lines claim_lines(const analysis::Claim& claim)
{
    Lines lines = {{"claim", claim.statement}, {"where", claim.place}};
    if (claim.rule != analysis::ClaimRule::untestable)
        lines.emplace_back("study", fmt::format("{}, about {:g} min", claim.study, claim.cost_minutes));
    for (auto& line : measure_of(claim)) lines.push_back(std::move(line));
    lines.emplace_back("formula", fmt::format("{}", fmt::join(claim.formulae, "\n")));
    return lines;
}

}  // namespace experiments

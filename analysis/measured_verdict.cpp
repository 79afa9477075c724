#include "analysis/measured_verdict.hpp"

#include "analysis/measurement.hpp"
#include "analysis/verdict_texts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace analysis {
namespace {

std::vector<Measurement> of_quantities(const Claim& claim, const std::vector<std::string>& quantities, const Records& records)
{
    std::vector<Measurement> found;
    for (const std::string& quantity : quantities)
        for (const Measurement& measured : records.measurements)
            if (measured.claim == claim.id && measured.quantity == quantity) found.push_back(measured);
    return found;
}

struct Count {
    int within = 0, all = 0;
};

std::map<std::string, Count> counts_by_subject(const Verdict& verdict)
{
    std::map<std::string, Count> counts;
    for (const Measurement& measured : verdict.measurements) {
        Count& count = counts[measured.of.substr(0, measured.of.find(','))];
        ++count.all;
        count.within += extent_of(verdict.claim, measured) == Extent::whole;
    }
    return counts;
}

// How far outside, in the bound's own size; what is not a number is farthest.
double distance_outside(const Claim& claim, const Measurement& measured)
{
    const QuantityBound bound = bound_of(claim, measured.quantity);
    if (std::isnan(measured.value)) return std::numeric_limits<double>::infinity();
    const double below = (bound.low - measured.value) / std::max(std::abs(bound.low), 1e-300);
    const double above = (measured.value - bound.high) / std::max(std::abs(bound.high), 1e-300);
    return std::max({0.0, below, above});
}

std::string farthest_text(const Verdict& verdict)
{
    const auto farther = [&](const Measurement& a, const Measurement& b) {
        return distance_outside(verdict.claim, a) < distance_outside(verdict.claim, b);
    };
    const Measurement& farthest = *std::max_element(verdict.measurements.begin(), verdict.measurements.end(), farther);
    return fmt::format("farthest: {} of {} is {}", farthest.quantity, farthest.of, figure_text(farthest));
}

std::string text_of(const Verdict& verdict)
{
    std::vector<std::string> holding, failing;
    for (const auto& [subject, count] : counts_by_subject(verdict))
        if (count.within == 0)
            failing.push_back(subject);
        else
            holding.push_back(count.within == count.all ? subject : fmt::format("{} ({} of {} figures)", subject, count.within, count.all));
    std::string text = label(verdict.kind);
    if (!holding.empty()) text += fmt::format("{} {}", verdict.kind == VerdictKind::reproduced ? ":" : "", fmt::join(holding, ", "));
    if (verdict.kind == VerdictKind::reproduced) return text;
    if (!failing.empty()) text += fmt::format("{}{}", holding.empty() ? ": " : "; not for ", fmt::join(failing, ", "));
    return text + "; " + farthest_text(verdict);
}

}  // namespace

Verdict judge_measurements(const Claim& claim, const Records& records)
{
    Verdict verdict = verdict_of(claim, VerdictKind::not_computable, "");
    verdict.measurements = of_quantities(claim, claim.metrics, records);
    verdict.measured_beside = of_quantities(claim, claim.beside, records);
    if (verdict.measurements.empty() && !records.left_out.empty())
        return verdict_of(claim, VerdictKind::cannot_be_tested_here, left_out_text(records.left_out));
    if (verdict.measurements.empty()) return verdict_of(claim, VerdictKind::not_computable, "nothing was measured");
    std::set<std::string> runs;
    std::size_t holding = 0;
    for (const Measurement& measured : verdict.measurements) {
        holding += extent_of(claim, measured) == Extent::whole;
        if (!measured.run.empty()) runs.insert(measured.run);
    }
    verdict.runs.assign(runs.begin(), runs.end());
    verdict.measured = fmt::format("{} of {} figures within", holding, verdict.measurements.size());
    verdict.kind = holding == verdict.measurements.size() ? VerdictKind::reproduced
                   : holding > 0                          ? VerdictKind::reproduced_only_for
                                                          : VerdictKind::not_reproduced;
    verdict.text = verdict.summary = text_of(verdict);
    if (!records.left_out.empty()) verdict.text += "; left out: " + left_out_text(records.left_out);
    return verdict;
}

}  // namespace analysis

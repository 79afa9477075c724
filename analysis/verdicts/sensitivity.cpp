#include "analysis/verdicts/sensitivity.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace analysis {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

std::vector<BodyExcluded> without_each_body(const Claim& claim, const std::vector<Measurement>& measured)
{
    std::set<std::string> bodies;
    for (const JudgedCase& tested : judged(claim, claim.own, measured).cases)
        if (!tested.of.body.empty()) bodies.insert(tested.of.body);
    std::vector<BodyExcluded> verdicts;
    for (const std::string& body : bodies) {
        std::vector<Measurement> others;
        std::ranges::copy_if(measured, std::back_inserter(others),
                             [&](const Measurement& measurement) { return measurement.of.body != body; });
        verdicts.push_back({body, kind_on(claim, others, measured)});
    }
    return verdicts;
}

// The claim with another value of an end of its threshold, and its controls and comparisons with the same thresholds
// likewise.
Claim with_end(const Claim& claim, std::size_t threshold, double Threshold::*end, double value)
{
    Claim other = claim;
    other.own.thresholds[threshold].*end = value;
    for (Selection& selection : other.others)
        if (selection.thresholds == claim.own.thresholds) selection.thresholds = other.own.thresholds;
    return other;
}

// The numbers of all cases, and of their parts, that are compared with the claim's own thresholds: at these the verdict
// may change.
std::vector<double> numbers_of(const Claim& claim, const std::vector<Measurement>& measured)
{
    std::set<double> numbers;
    const auto add = [&](const Selection& selection) {
        for (const JudgedCase& tested : judged(claim, selection, measured).cases) {
            if (std::isfinite(tested.value)) numbers.insert(tested.value);
            for (const JudgedCase& part : tested.parts)
                if (std::isfinite(part.value)) numbers.insert(part.value);
        }
    };
    add(claim.own);
    for (const Selection& other : claim.others)
        if (other.role != Role::comparison && other.thresholds == claim.own.thresholds) add(other);
    return {numbers.begin(), numbers.end()};
}

// A value at an end of the threshold holds. So the numbers x_i at which a verdict may change divide a high end into
// [x_i, x_i+1), and a low end into (x_i, x_i+1]: the verdict is that at one point of each.
ThresholdRange range_of(const Claim& claim, const std::vector<Measurement>& measured,
                        const std::vector<double>& numbers, VerdictKind kind, std::size_t threshold, bool is_high)
{
    double Threshold::*end = is_high ? &Threshold::high : &Threshold::low;
    const Threshold& own = claim.own.thresholds[threshold];
    ThresholdRange range{.threshold = own, .is_high = is_high, .low = -infinite, .high = infinite};
    const auto stands_at = [&](double value) {
        return kind_on(with_end(claim, threshold, end, value), measured) == kind;
    };
    const double value = own.*end;
    const auto above = is_high ? std::ranges::upper_bound(numbers, value) : std::ranges::lower_bound(numbers, value);
    for (auto next = above; next != numbers.end(); ++next)
        if (!stands_at(is_high ? *next : std::nextafter(*next, infinite))) {
            range.high = *next;
            break;
        }
    for (auto last = std::make_reverse_iterator(above); last != numbers.rend(); ++last)
        if (!stands_at(is_high ? std::nextafter(*last, -infinite) : *last)) {
            range.low = *last;
            break;
        }
    return range;
}

std::vector<ThresholdRange> ranges_of(const Claim& claim, const std::vector<Measurement>& measured, VerdictKind kind)
{
    const std::vector<double> numbers = numbers_of(claim, measured);
    std::vector<ThresholdRange> ranges;
    for (std::size_t i = 0; i < claim.own.thresholds.size(); ++i)
        for (const bool is_high : {false, true})
            if (std::isfinite(is_high ? claim.own.thresholds[i].high : claim.own.thresholds[i].low))
                ranges.push_back(range_of(claim, measured, numbers, kind, i, is_high));
    return ranges;
}

}  // namespace

Sensitivity sensitivity(const Claim& claim, const Records& records)
{
    if (claim.rule != ClaimRule::cases || !missing_from(records).empty()) return {};
    const std::vector<Measurement> measured = own_measurements(claim, records);
    return {without_each_body(claim, measured), ranges_of(claim, measured, kind_on(claim, measured))};
}

}  // namespace analysis

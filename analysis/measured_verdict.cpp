#include "analysis/measured_verdict.hpp"

#include "analysis/measurement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

namespace analysis {
namespace {

template <typename Predicate>
void add_of(const std::vector<std::string>& quantities, const Records& records, std::vector<Measurement>& to, Predicate is_wanted)
{
    for (const std::string& quantity : quantities)
        for (const Measurement& measured : records.measurements)
            if (measured.quantity == quantity && is_wanted(measured)) to.push_back(measured);
}

struct Count {
    int within = 0, all = 0;
};

// The values of a subject, grouped by quantity and by the fields that the claim counts apart: how many there are, and how many hold.
using Subject = std::map<std::vector<std::string>, Count>;

std::vector<std::string> group_of(const Claim& claim, const Measurement& measured)
{
    std::vector<std::string> group = {measured.quantity};
    for (const std::string& field : claim.each) group.push_back(value_text(*case_key_field(field), measured.of));
    return group;
}

std::map<std::string, Subject> by_subject(const Verdict& verdict)
{
    std::map<std::string, Subject> subjects;
    for (const Measurement& measured : verdict.measurements) {
        Count& count = subjects[value_text(*case_key_field(verdict.claim.subject), measured.of)][group_of(verdict.claim, measured)];
        ++count.all;
        count.within += extent_of(verdict.claim, measured) == Extent::whole;
    }
    return subjects;
}

Count sum_of(const Subject& subject)
{
    Count sum;
    for (const auto& [quantity, count] : subject) sum = {sum.within + count.within, sum.all + count.all};
    return sum;
}

// A claim of several quantities requires all of them.
Extent extent_of(const Subject& subject)
{
    const auto some = [](const auto& entry) { return entry.second.within > 0; };
    if (sum_of(subject).within == sum_of(subject).all) return Extent::whole;
    return std::all_of(subject.begin(), subject.end(), some) ? Extent::part : Extent::none;
}

VerdictKind kind_of(const std::map<std::string, Subject>& subjects)
{
    const auto holds = [](Extent least) { return [least](const auto& entry) { return extent_of(entry.second) >= least; }; };
    if (std::all_of(subjects.begin(), subjects.end(), holds(Extent::whole))) return VerdictKind::reproduced;
    return std::any_of(subjects.begin(), subjects.end(), holds(Extent::part)) ? VerdictKind::reproduced_only_for
                                                                              : VerdictKind::not_reproduced;
}

// How far the value lies outside, relative to the size of the bound; negative inside. NaN counts as farthest outside. An open end counts
// only where an infinite value lies beyond it.
double distance_outside(const QuantityBound& bound, double value)
{
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const auto relative = [](double by, double end) {
        if (std::abs(end) >= open_end) return by == infinity ? by : -infinity;
        return by / std::max(std::abs(end), 1e-300);
    };
    if (std::isnan(value)) return infinity;
    return std::max(relative(bound.low - value, bound.low), relative(value - bound.high, bound.high));
}

// A value outside the bound is worse than one whose interval leaves it, and that one is worse than any that holds.
PrimaryFact worst_of(const Verdict& verdict)
{
    const auto holds_and_distance = [&](const Measurement& of) {
        return std::pair(extent_of(verdict.claim, of), -distance_outside(bound_of(verdict.claim, of.quantity), of.value));
    };
    const Measurement& worst = *std::ranges::min_element(verdict.measurements, {}, holds_and_distance);
    const QuantityBound bound = bound_of(verdict.claim, worst.quantity);
    return {worst.quantity, "value", worst.unit, worst.value, worst.low, worst.high, bound.low, bound.high, worst.of};
}

}  // namespace

Verdict judge_measurements(const Claim& claim, const Records& records)
{
    Verdict verdict = verdict_of(claim, VerdictKind::not_computable);
    verdict.left_out = records.left_out;
    verdict.missing = records.missing_runs;
    if (!verdict.missing.empty()) return verdict;
    add_of(claim.metrics, records, verdict.measurements, [&](const Measurement& measured) { return is_judged(claim, measured); });
    add_of(claim.metrics, records, verdict.controls, [&](const Measurement& measured) { return is_control(claim, measured); });
    add_of(claim.reported, records, verdict.controls, [&](const Measurement& measured) { return measured.claim == claim.id; });
    if (verdict.measurements.empty()) {
        if (!records.left_out.empty()) verdict.kind = VerdictKind::cannot_be_tested_here;
        return verdict;
    }
    std::set<std::string> runs;
    for (const Measurement& measured : verdict.measurements) {
        verdict.within += extent_of(claim, measured) == Extent::whole;
        if (!measured.run.empty()) runs.insert(measured.run);
    }
    verdict.n = static_cast<int>(verdict.measurements.size());
    verdict.runs.assign(runs.begin(), runs.end());
    const auto subjects = by_subject(verdict);
    for (const auto& [name, subject] : subjects)
        verdict.subjects.push_back({name, sum_of(subject).within, sum_of(subject).all, extent_of(subject)});
    verdict.kind = kind_of(subjects);
    verdict.primary = worst_of(verdict);
    return verdict;
}

}  // namespace analysis

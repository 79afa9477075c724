#include "analysis/verdicts/verdict.hpp"

#include "analysis/statistics/statistics.hpp"

#include <cmath>
#include <map>
#include <set>

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

bool is_judged(const Claim& claim, const CaseRecord& record)
{
    return (claim.iterations == 0 || record.iterations == claim.iterations) && !record.frame.empty();
}

bool is_asked_for(const Claim& claim, const CaseRecord& record)
{
    return record.deformer == claim.deformer && is_judged(claim, record);
}

const CaseRecord* own_record(const Claim& claim, const Records& records, const std::string& scene)
{
    const auto found = std::ranges::find_if(records.cases, [&](const CaseRecord& record) {
        return record.scene == scene && is_asked_for(claim, record) && (record.variant.empty() || record.variant == "default");
    });
    return found == records.cases.end() ? nullptr : &*found;
}

OrderVerdict& entry_of(std::vector<OrderVerdict>& verdicts, const CaseRecord& record)
{
    const auto same = [&](const OrderVerdict& entry) { return entry.order == record.order && entry.precision == record.precision; };
    const auto found = std::find_if(verdicts.begin(), verdicts.end(), same);
    if (found != verdicts.end()) return *found;
    verdicts.push_back({.order = record.order, .precision = record.precision});
    return verdicts.back();
}

void add_case(const Claim& claim, const CaseRecord& other, const CaseRecord& own, OrderVerdict& verdict)
{
    for (const std::string& metric : claim.metrics) {
        verdict.cases.push_back(judge_case(claim, other, metric));
        verdict.own_cases.push_back(judge_case(claim, own, metric));
        if (verdict.cases.back().extent != verdict.own_cases.back().extent) verdict.differing.push_back(verdict.cases.size() - 1);
    }
}

// Scenes that were planned and have neither a record nor a reason for its absence.
std::vector<std::string> missing_scenes(const Claim& claim, const Records& records)
{
    std::vector<std::string> missing;
    for (const std::string& scene : records.planned_scenes) {
        const bool recorded = std::any_of(records.cases.begin(), records.cases.end(),
                                          [&](const CaseRecord& record) { return record.scene == scene && is_asked_for(claim, record); });
        const bool left_out =
            std::any_of(records.left_out.begin(), records.left_out.end(), [&](const LeftOut& entry) { return entry.scene == scene; });
        if (!recorded && !left_out) missing.push_back(scene);
    }
    return missing;
}

// Chooses the clip that represents the claim, by the claim's own metric: the one with the lowest share, or with the mean farthest from the
// printed value.
void choose_primary(Verdict& verdict)
{
    const bool by_share = verdict.claim.rule == ClaimRule::share_within;
    double worst = -std::numeric_limits<double>::infinity();
    for (const CaseJudgement& judged : verdict.cases) {
        if (judged.sweep || judged.metric != verdict.claim.metrics.front()) continue;
        const double distance = by_share ? -judged.share.estimate : std::abs(judged.mean.estimate - verdict.claim.expected);
        if (!(distance > worst)) continue;
        worst = distance;
        verdict.interval = by_share ? judged.share : judged.mean;
        const Interval& interval = verdict.interval;
        verdict.primary = PrimaryFact{judged.metric,
                                      by_share ? "share_of_frames" : "mean",
                                      by_share ? "1" : "%",
                                      interval.estimate,
                                      interval.low,
                                      interval.high,
                                      by_share ? verdict.claim.share : verdict.claim.low,
                                      by_share ? 1.0 : verdict.claim.high,
                                      judged.of};
    }
}

void count_and_list_runs(Verdict& verdict)
{
    std::set<std::string> runs;
    for (const CaseJudgement& judged : verdict.cases) {
        if (!judged.run.empty()) runs.insert(judged.run);
        if (judged.metric != verdict.claim.metrics.front()) continue;
        ++verdict.n;
        verdict.within += judged.extent == Extent::whole;
    }
    verdict.runs.assign(runs.begin(), runs.end());
}

Verdict judge_cases(const Claim& claim, const Records& records)
{
    if (const auto missing = missing_scenes(claim, records); !missing.empty()) {
        Verdict none = verdict_of(claim, VerdictKind::not_computable);
        none.missing = missing;
        return none;
    }
    Verdict verdict = verdict_of(claim, VerdictKind::not_computable);
    verdict.left_out = records.left_out;
    for (const std::string& metric : claim.metrics)
        for (const CaseRecord& record : records.cases)
            if (is_asked_for(claim, record) && !record.beside) verdict.cases.push_back(judge_case(claim, record, metric));
    if (verdict.cases.empty()) {
        if (!records.left_out.empty()) verdict.kind = VerdictKind::cannot_be_tested_here;
        return verdict;
    }
    for (const CaseRecord& record : records.cases)
        if (is_asked_for(claim, record) && record.beside) verdict.compared.push_back(judge_case(claim, record, claim.metrics.front()));
    for (const std::string& deformer : claim.compared)
        for (const CaseRecord& record : records.cases)
            if (record.deformer == deformer && !record.frame.empty())
                verdict.compared.push_back(judge_case(claim, record, claim.metrics.front()));
    verdict.kind = kind_of(claim, verdict.cases);
    verdict.orders = judge_orders(claim, records);
    choose_primary(verdict);
    count_and_list_runs(verdict);
    return verdict;
}

// How far the value lies outside, relative to the size of the bound; negative inside.
double distance_outside(const PrintedValue& value)
{
    const double below = (value.least - value.printed) / std::max(std::abs(value.least), 1e-300);
    const double above = std::isinf(value.most) ? -value.most : (value.printed - value.most) / std::max(std::abs(value.most), 1e-300);
    return std::max(below, above);
}

Verdict judge_print(const Claim& claim, const std::vector<PrintedValue>& values)
{
    Verdict verdict = verdict_of(claim, VerdictKind::not_computable);
    for (const PrintedValue& value : values)
        if (value.claim == claim.id) verdict.printed.push_back(value);
    if (verdict.printed.empty()) return verdict;
    verdict.n = static_cast<int>(verdict.printed.size());
    verdict.within = static_cast<int>(
        std::count_if(verdict.printed.begin(), verdict.printed.end(), [](const auto& value) { return value.is_consistent(); }));
    verdict.kind = verdict.within == verdict.n ? VerdictKind::reproduced : VerdictKind::inconsistent_in_print;
    const PrintedValue& farthest = *std::max_element(verdict.printed.begin(), verdict.printed.end(), [](const auto& a, const auto& b) {
        return distance_outside(a) < distance_outside(b);
    });
    verdict.primary = PrimaryFact{farthest.quantity, "printed",     "",         farthest.printed, farthest.printed, farthest.printed,
                                  farthest.least,    farthest.most, farthest.of};
    return verdict;
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

std::vector<OrderVerdict> judge_orders(const Claim& claim, const Records& records)
{
    std::vector<OrderVerdict> verdicts;
    if (claim.orders.empty()) return verdicts;
    for (const CaseRecord& record : records.cases) {
        if (record.deformer != claim.orders || !is_judged(claim, record)) continue;
        if (const CaseRecord* own = own_record(claim, records, record.scene)) add_case(claim, record, *own, entry_of(verdicts, record));
    }
    for (OrderVerdict& verdict : verdicts) {
        verdict.kind = kind_of(claim, verdict.cases);
        verdict.own_kind = kind_of(claim, verdict.own_cases);
    }
    return verdicts;
}

VerdictKind kind_of(const Claim& claim, const std::vector<CaseJudgement>& cases)
{
    const auto is_whole_or_other = [&](const CaseJudgement& judged) {
        return judged.extent == Extent::whole || judged.metric != claim.metrics.front();
    };
    const auto holds_somewhere = [](const CaseJudgement& judged) { return judged.extent != Extent::none; };
    if (std::all_of(cases.begin(), cases.end(), is_whole_or_other)) return VerdictKind::reproduced;
    if (std::any_of(cases.begin(), cases.end(), holds_somewhere)) return VerdictKind::reproduced_only_for;
    return VerdictKind::not_reproduced;
}

Verdict judge(const Claim& claim, const Records& records)
{
    switch (claim.rule) {
        case ClaimRule::printed:
            return judge_print(claim, records.printed);
        case ClaimRule::measured:
            return judge_measurements(claim, records);
        case ClaimRule::untestable:
            return verdict_of(claim, VerdictKind::cannot_be_tested_here);
        default:
            return judge_cases(claim, records);
    }
}

Verdict verdict_of(const Claim& claim, VerdictKind kind)
{
    Verdict verdict;
    verdict.claim = claim;
    verdict.kind = kind;
    verdict.interval = {not_known, not_known, not_known, claim.level, 0, 0};
    return verdict;
}

const char* name_of(VerdictKind kind)
{
    static constexpr std::array names = {
        "reproduced", "reproduced_only_for", "not_reproduced", "inconsistent_in_print", "cannot_be_tested_here", "not_computable"};
    return names[static_cast<std::size_t>(kind)];
}

const char* name_of(Extent extent)
{
    static constexpr std::array names = {"none", "part", "whole"};
    return names[static_cast<std::size_t>(extent)];
}

}  // namespace analysis

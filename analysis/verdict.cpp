#include "analysis/verdict.hpp"

#include "analysis/measured_verdict.hpp"
#include "analysis/order_verdicts.hpp"
#include "analysis/statistics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

namespace analysis {
namespace {

bool is_asked_for(const Claim& claim, const CaseRecord& record)
{
    return record.deformer == claim.deformer && (claim.iterations == 0 || record.iterations == claim.iterations) && !record.frame.empty();
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

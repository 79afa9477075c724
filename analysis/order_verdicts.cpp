#include "analysis/order_verdicts.hpp"

#include <algorithm>

namespace analysis {
namespace {

bool is_judged(const Claim& claim, const CaseRecord& record)
{
    return (claim.iterations == 0 || record.iterations == claim.iterations) && !record.frame.empty();
}

bool is_own(const Claim& claim, const CaseRecord& record)
{
    return record.deformer == claim.deformer && (record.variant.empty() || record.variant == "default") && is_judged(claim, record);
}

const CaseRecord* own_record(const Claim& claim, const Records& records, const std::string& scene)
{
    const auto found = std::find_if(records.cases.begin(), records.cases.end(),
                                    [&](const CaseRecord& record) { return record.scene == scene && is_own(claim, record); });
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

}  // namespace

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

}  // namespace analysis

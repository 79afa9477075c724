#include "experiments/studies/ambiguity/judged_value.hpp"

#include "pbs/character/body_cache.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace experiments {
namespace {

JudgedValue of_case(const analysis::Claim& claim, const analysis::CaseRecord& record, const std::string& metric)
{
    const analysis::CaseJudgement judgement = analysis::judge_case(claim, record, metric);
    const bool of_share = claim.rule == analysis::ClaimRule::share_within;
    return {claim.id,
            (of_share ? "share_of_frames_by_" : "mean_") + metric,
            {.body = record.scene},
            of_share ? "1" : "%",
            of_share ? analysis::bound_text({"", claim.share, 1.0}) : analysis::bound_text({"", claim.low, claim.high}),
            of_share ? judgement.share.estimate : judgement.mean.estimate,
            judgement.extent};
}

}  // namespace

std::string digest_of(const std::vector<analysis::Claim>& claims)
{
    nlohmann::json all = nlohmann::json::array();
    for (const analysis::Claim& claim : claims) {
        all.push_back({claim.id, static_cast<int>(claim.rule), claim.metrics, claim.deformer, claim.iterations, claim.low, claim.high,
                       claim.share, claim.part, claim.level});
        for (const analysis::QuantityBound& bound : claim.bounds) all.push_back({bound.quantity, bound.low, bound.high});
    }
    return pbs::content_hash(all.dump());
}

std::vector<LeftOutQuantity> all_but(const std::string& claim, const std::vector<std::string>& measured, const std::string& reason)
{
    std::vector<LeftOutQuantity> left_out;
    for (const std::string& quantity : claim_named(claim).metrics)
        if (std::find(measured.begin(), measured.end(), quantity) == measured.end()) left_out.push_back({claim, quantity, reason});
    return left_out;
}

std::vector<JudgedValue> judged(const std::vector<analysis::Measurement>& measured)
{
    std::vector<JudgedValue> values;
    for (const analysis::Measurement& one : measured) {
        const analysis::Claim& claim = claim_named(one.claim);
        if (!analysis::is_judged(claim, one)) continue;
        values.push_back({one.claim, one.quantity, one.of, one.unit, analysis::bound_text(analysis::bound_of(claim, one.quantity)),
                          one.value, analysis::extent_of(claim, one), one.limit});
    }
    return values;
}

std::vector<JudgedValue> judged(const ReadMotion& moved)
{
    std::vector<JudgedValue> values;
    for (const analysis::Claim& claim : claims()) {
        if (claim.study != "volume") continue;
        for (const std::string& metric : claim.metrics)
            values.push_back(of_case(claim, claim.deformer == "lbs" ? moved.lbs : moved.pbs, metric));
    }
    return values;
}

}  // namespace experiments

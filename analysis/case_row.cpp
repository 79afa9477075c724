#include "analysis/case_row.hpp"

#include "analysis/case_texts.hpp"

#include <fmt/format.h>

namespace analysis {
namespace {

std::string measured_by(const CaseJudgement& judged)
{
    return judged.sweep ? span_text(judged) : fmt::format("mean {} %, {}", figure(judged.mean.estimate), span_text(judged));
}

std::string interval_by(const Claim& claim, const CaseJudgement& judged)
{
    if (judged.sweep) return "";
    if (claim.rule == ClaimRule::share_within) return share_text(judged);
    return fmt::format("mean{} %", bounds_text(judged.mean, 1.0));
}

std::string angles_held(const CaseJudgement& judged)
{
    return judged.angles.empty() ? "at no angle" : fmt::format("at {} of {:.4g} deg", angle_ranges(judged), judged.last_angle_deg);
}

std::string where_it_holds(const CaseJudgement& judged)
{
    const std::string text = judged.sweep                     ? angles_held(judged)
                             : judged.extent == Extent::whole ? "yes"
                             : judged.extent == Extent::part  ? "in single frames"
                                                              : "no";
    return text + inverted_text(judged);
}

}  // namespace

CaseRow case_row(const Claim& claim, const CaseJudgement& judgement)
{
    return {case_name(judgement), measured_by(judgement), interval_by(claim, judgement), where_it_holds(judgement)};
}

}  // namespace analysis

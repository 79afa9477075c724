#include "analysis/case_row.hpp"

#include <fmt/format.h>

namespace analysis {
namespace {

std::string measured_by(const CaseJudgement& judged)
{
    const std::string range = fmt::format("{:.3g} to {:.3g} %", judged.least, judged.most);
    return judged.sweep ? range : fmt::format("mean {:.3g} %, {}", judged.mean.estimate, range);
}

std::string interval_by(const Claim& claim, const CaseJudgement& judged)
{
    if (judged.sweep) return "";
    if (claim.rule == ClaimRule::share_within)
        return fmt::format("{:.3g} % [{:.3g}, {:.3g}] of {} frames", 100.0 * judged.share.estimate, 100.0 * judged.share.low,
                           100.0 * judged.share.high, judged.frames);
    return fmt::format("mean [{:.3g}, {:.3g}] %", judged.mean.low, judged.mean.high);
}

std::string angles_held(const CaseJudgement& judged)
{
    if (judged.angles.empty()) return "at no angle";
    std::string text = "at ";
    for (const AngleRange& range : judged.angles)
        text += fmt::format("{}{:.4g} to {:.4g}", text.size() > 3 ? ", " : "", range.from_deg, range.to_deg);
    return text + fmt::format(" of {:.4g} deg", judged.last_angle_deg);
}

std::string where_it_holds(const CaseJudgement& judged)
{
    std::string text = judged.sweep                     ? angles_held(judged)
                       : judged.extent == Extent::whole ? "yes"
                       : judged.extent == Extent::part  ? "in single frames"
                                                        : "no";
    if (judged.holding_with_inverted_tets > 0)
        text += fmt::format("; inverted tets in {} frames within", judged.holding_with_inverted_tets);
    return text;
}

}  // namespace

CaseRow case_row(const Claim& claim, const CaseJudgement& judgement)
{
    return {case_name(judgement), measured_by(judgement), interval_by(claim, judgement), where_it_holds(judgement)};
}

}  // namespace analysis

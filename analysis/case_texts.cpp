// What the judgement of one case says in words; every figure comes from the judgement.
#include "analysis/case_texts.hpp"

#include <fmt/format.h>

#include <cmath>

namespace analysis {

std::string figure(double value)
{
    return std::abs(value) < 5e-4 ? "0" : fmt::format("{:.3g}", value);
}

std::string bounds_text(const Interval& interval, double factor)
{
    return std::isnan(interval.low) ? "" : fmt::format(" [{}, {}]", figure(factor * interval.low), figure(factor * interval.high));
}

std::string share_text(const CaseJudgement& judgement)
{
    return fmt::format("{} %{} of {} frames", figure(100.0 * judgement.share.estimate), bounds_text(judgement.share, 100.0),
                       judgement.frames);
}

std::string span_text(const CaseJudgement& judgement)
{
    return fmt::format("{} to {} %", figure(judgement.least), figure(judgement.most));
}

std::string angle_ranges(const CaseJudgement& judgement)
{
    std::vector<std::string> ranges;
    for (const auto& [from, to] : judgement.angles)
        ranges.push_back(from == to ? fmt::format("{:.4g}", to) : fmt::format("{:.4g} to {:.4g}", from, to));
    return fmt::format("{}", fmt::join(ranges, ", "));
}

std::string inverted_text(const CaseJudgement& judgement)
{
    const int frames = judgement.holding_with_inverted_tets;
    return frames == 0 ? "" : fmt::format(" (inverted tets in {} of the frames within)", frames);
}

namespace {

std::string mean_text(const CaseJudgement& judgement)
{
    return fmt::format("mean {} %{}", figure(judgement.mean.estimate), bounds_text(judgement.mean, 1.0));
}

std::string angles_text(const CaseJudgement& judgement)
{
    return judgement.angles.empty() ? "at no angle" : fmt::format("at {} deg", angle_ranges(judgement));
}

std::string worst_text(const CaseJudgement& judgement)
{
    if (judgement.deepest.empty()) return "";
    const FailingFrame& frame = judgement.deepest.front();
    return fmt::format(", worst {:.3g} % at {}", frame.value,
                       judgement.sweep ? fmt::format("{:.4g} deg", frame.angle_deg) : fmt::format("{:.4g} s", frame.time_s));
}

std::string short_sweep_text(const CaseJudgement& judgement)
{
    if (judgement.extent == Extent::none) return fmt::format(" ({})", span_text(judgement));
    if (judgement.rule == ClaimRule::mean_within) return fmt::format(" {}", angles_text(judgement));
    return fmt::format(" up to {:.4g} of {:.4g} deg", judgement.angles.front().to_deg, judgement.last_angle_deg);
}

std::string short_clip_text(const CaseJudgement& judgement)
{
    if (judgement.rule == ClaimRule::share_within) return fmt::format(" ({} within)", share_text(judgement));
    if (judgement.extent == Extent::part)
        return fmt::format(" in {:.3g} % of frames ({})", 100.0 * judgement.share.estimate, mean_text(judgement));
    return fmt::format(" ({})", mean_text(judgement));
}

}  // namespace

std::string case_name(const CaseJudgement& judgement)
{
    const bool plain = judgement.variant.empty() || judgement.variant == "default";
    return plain ? judgement.scene : fmt::format("{} ({})", judgement.scene, judgement.variant);
}

std::string short_text(const CaseJudgement& judgement)
{
    return case_name(judgement) + (judgement.sweep ? short_sweep_text(judgement) : short_clip_text(judgement)) + inverted_text(judgement);
}

std::string measured_text(const CaseJudgement& judgement)
{
    const std::string frames = judgement.sweep ? fmt::format("within {} of {:.4g}", angles_text(judgement), judgement.last_angle_deg)
                                               : fmt::format("{}, {} within", mean_text(judgement), share_text(judgement));
    return fmt::format("{}: {}, {}{}{}", case_name(judgement), frames, span_text(judgement), worst_text(judgement),
                       inverted_text(judgement));
}

}  // namespace analysis

#include "experiments/studies/improvements/gains_page.hpp"

#include "analysis/records/report_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace experiments {
namespace {

std::string spoken(std::string name)
{
    std::ranges::replace(name, '_', ' ');
    return name;
}

std::string remark_on(const GainRow& gain)
{
    switch (gain.decision) {
        case GainDecision::decided:
            return "decided";
        case GainDecision::few_poses:
            return fmt::format("undecided: fewer than {} poses", fewest_poses);
        case GainDecision::poses_disagree:
            return "undecided: the interval over the poses includes zero";
        case GainDecision::reference_error:
            break;
    }
    return gain.reference_error_pct
               ? fmt::format("undecided: the reference's own error may change it by {:.2g} points", *gain.reference_error_pct)
               : "undecided: the reference's own error is not known";
}

std::string interval_of(const GainRow& gain)
{
    return gain.gain_low_pct ? fmt::format("{:.2f} ({:.2f} to {:.2f})", gain.gain_pct, *gain.gain_low_pct, *gain.gain_high_pct)
                             : fmt::format("{:.2f}", gain.gain_pct);
}

std::string of_the_control(const std::vector<GainRow>& gains)
{
    const auto own = std::ranges::find(gains, control, &GainRow::change);
    return own == gains.end() ? ""
                              : fmt::format(" Other values of k_stretch or k_bind, which change nothing else, gain {} [{}].",
                                            interval_of(*own), remark_on(*own));
}

// The answer at one budget. gains: of this budget, the largest first, then the comparison of the first one with the second.
std::string answer(const std::vector<GainRow>& gains)
{
    const auto versus = std::ranges::find_if(gains, [](const GainRow& gain) { return gain.than != baseline; });
    if (versus == gains.end()) return "";
    const auto best = std::ranges::find(gains, versus->change, &GainRow::change);
    if (best->gain_pct <= 0.0)
        return fmt::format(
            "The mean error of the baseline over {} poses is {:.2f} %, and no single change reduces it. The best change, {}, gains {} "
            "percentage points [{}].{}\n",
            best->poses, best->than_error_pct, spoken(best->change), interval_of(*best), remark_on(*best), of_the_control(gains));
    return fmt::format(
        "The change with the largest mean gain is {}: over {} poses the mean error at the joints is {:.2f} % instead of {:.2f} %, a gain "
        "of {} percentage points [{}]. Relative to the second one, {}, it gains {} [{}].{}\n",
        spoken(best->change), best->poses, best->error_pct, best->than_error_pct, interval_of(*best), remark_on(*best),
        spoken(versus->than), interval_of(*versus), remark_on(*versus), of_the_control(gains));
}

// The changes without a value in every pose, whose means are over other poses and cannot be compared. own: of one group and budget,
// relative to the baseline. changes: all of the study.
std::string omissions(const std::vector<GainRow>& own, const std::set<std::string>& changes)
{
    const int most = std::ranges::max(own, {}, &GainRow::poses).poses;
    std::string omitted;
    for (const std::string& change : changes) {
        const auto found = std::ranges::find(own, change, &GainRow::change);
        const int poses = found == own.end() ? 0 : found->poses;
        if (poses < most) omitted += fmt::format("{}{} ({} of {} poses)", omitted.empty() ? "" : ", ", spoken(change), poses, most);
    }
    return omitted.empty() ? "" : "\nNot ranked, because no setting fits into the budget in every pose: " + omitted + ".\n";
}

}  // namespace

std::string gains_page(const std::vector<GainRow>& gains)
{
    std::set<std::string> changes;
    for (const GainRow& gain : gains)
        if (gain.than == baseline) changes.insert(gain.change);
    std::string page;
    for (std::size_t first = 0; first < gains.size();) {
        std::vector<GainRow> own;  // of one group at one budget, which follow each other
        for (; first < gains.size() && (own.empty() || (gains[first].group == own.front().group &&
                                                        gains[first].budget_iterations == own.front().budget_iterations));
             ++first)
            own.push_back(gains[first]);
        const std::string poses = own.front().group == all_poses ? "all poses" : "the poses of the body " + own.front().group;
        page += fmt::format("## In the time of {} iterations of PBS, {}\n\n{}\n", own.front().budget_iterations, poses, answer(own));
        std::erase_if(own, [](const GainRow& gain) { return gain.than != baseline; });
        page += markdown_table(table_of(gain_columns, own), {{"change", "change"},
                                                             {"poses", "poses"},
                                                             {"iterations", "iterations", "{:.1f}"},
                                                             {"error [%]", "error_pct", "{:.2f}"},
                                                             {"of PBS [%]", "than_error_pct", "{:.2f}"},
                                                             {"gain [points]", "gain_pct", "{:.2f}"},
                                                             {"from", "gain_low_pct", "{:.2f}"},
                                                             {"to", "gain_high_pct", "{:.2f}"},
                                                             {"reference's error [points]", "reference_error_pct", "{:.2f}"},
                                                             {"decision", "decision"},
                                                             {"volume change [%]", "volume_abs_pct", "{:.2f}"},
                                                             {"settings", "settings"}}) +
                omissions(own, changes) + "\n";
    }
    return page;
}

}  // namespace experiments

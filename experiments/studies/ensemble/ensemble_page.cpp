#include "experiments/studies/ensemble/ensemble_page.hpp"

#include "analysis/records/report_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace experiments {
namespace {

constexpr double notable_pct = 2.0;  // pairs that differ by more than this are to be decided

bool is_notable(const PairRow& pair)
{
    return pair.largest_difference_pct > notable_pct;
}

struct Count {
    std::ptrdiff_t decided = 0, notable = 0;
};
Count count_decided(const std::vector<PairRow>& pairs, auto&& is_counted)
{
    Count count;
    for (const PairRow& pair : pairs) {
        if (!is_notable(pair) || !is_counted(pair)) continue;
        ++count.notable;
        count.decided += pair.decision == analysis::PairDecision::decided;
    }
    return count;
}

bool decides_nothing(const MemberRow& member)
{
    return member.outcome != "reached" || !member.error_bound_pct;
}

std::string members_that_decide_nothing(const std::vector<MemberRow>& members)
{
    std::vector<MemberRow> own;
    std::ranges::copy_if(members, std::back_inserter(own), decides_nothing);
    if (own.empty()) return "";
    return "\n## References that were not reached or have no bound on their own error\n\nThe worst tet is that with the smallest volume "
           "ratio in the finest solution. Tets that a solution inverts by their vertices alone are left out of the errors.\n\n" +
           markdown_table(table_of(member_columns, own), {{"body", "body"},
                                                          {"motion", "motion"},
                                                          {"pose", "pose"},
                                                          {"angle [deg]", "angle_deg"},
                                                          {"reference", "member"},
                                                          {"outcome", "outcome"},
                                                          {"worst tet", "worst_tet"},
                                                          {"its volume ratio", "j_min", "{:.3f}"},
                                                          {"inverted tets", "inverted"},
                                                          {"lowest det F", "lowest_det_f", "{:.3f}", 1.0, "-"}});
}

std::string minutes_per_pose(const std::vector<MemberRow>& members)
{
    std::vector<analysis::CaseKey> poses;
    std::map<analysis::CaseKey, double> minutes;
    for (const MemberRow& member : members) {
        if (!minutes.contains(member.of)) poses.push_back(member.of);
        minutes[member.of] += member.solve_s / 60.0;
    }
    std::string text = "\n## Wall time of all references of a pose\n\n| body | motion | pose | minutes |\n|---|---|---|---|\n";
    for (const analysis::CaseKey& pose : poses)
        text += fmt::format("| {} | {} | {} | {:.1f} |\n", pose.body, pose.motion,
                            pose.angle_deg ? fmt::format("{:g}", *pose.angle_deg) : pose.pose, minutes.at(pose));
    return text;
}

}  // namespace

std::string ensemble_page(const std::vector<PairRow>& pairs, const std::vector<MemberRow>& members)
{
    const Count all = count_decided(pairs, [](const PairRow&) { return true; });
    const Count skinning =
        count_decided(pairs, [](const PairRow& pair) { return pair.first != linear_elements && pair.second != linear_elements; });
    std::vector<PairRow> undecided;
    for (const PairRow& pair : pairs)
        if (is_notable(pair) && pair.decision != analysis::PairDecision::decided) undecided.push_back(pair);
    const auto reached = std::ranges::count(members, std::string("reached"), &MemberRow::outcome);
    const auto without_bound =
        std::ranges::count_if(members, [](const MemberRow& member) { return member.outcome == "reached" && !member.error_bound_pct; });
    std::string page = fmt::format(
        "{} of {} references were reached. {} of these have no bound on their own error and decide nothing, because too few of their "
        "solutions converged.\n\n",
        reached, members.size(), without_bound);
    page += fmt::format(
        "{} of {} pairs of deformers whose errors differ by more than {:g} percentage points are decided. Without linear finite elements, "
        "these are {} of {} pairs.\n",
        all.decided, all.notable, notable_pct, skinning.decided, skinning.notable);
    if (!undecided.empty())
        page += "\n" + markdown_table(table_of(pair_columns, undecided), {{"body", "body"},
                                                                          {"motion", "motion"},
                                                                          {"pose", "pose"},
                                                                          {"angle [deg]", "angle_deg"},
                                                                          {"first", "first"},
                                                                          {"second", "second"},
                                                                          {"largest difference [%]", "largest_difference_pct", "{:.1f}"},
                                                                          {"first closer", "first_is_closer"},
                                                                          {"second closer", "second_is_closer"},
                                                                          {"decision", "decision"}});
    return page + members_that_decide_nothing(members) + minutes_per_pose(members);
}

}  // namespace experiments

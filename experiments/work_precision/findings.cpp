#include "experiments/work_precision/findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace experiments {
namespace {

std::string ms_text(double ms)
{
    return ms < 100.0 ? fmt::format("{:.2g} ms", ms) : fmt::format("{:.0f} ms", ms);
}

std::vector<const DiagramPoint*> front_of(const Diagram& diagram)
{
    std::vector<analysis::WorkPrecision> all;
    for (const DiagramPoint& point : diagram.points) all.push_back({point.ms, point.error_pct});
    std::vector<const DiagramPoint*> front;
    for (const std::size_t on_front : analysis::pareto_front(all)) front.push_back(&diagram.points[on_front]);
    return front;
}

// Who alone is so quick: the groups that are there before any third one.
std::string who_is_quickest(const Diagram& diagram)
{
    std::vector<std::pair<double, std::string>> first;  // the least time of each group
    for (const DeformerGroup& group : deformer_groups()) {
        double least = std::numeric_limits<double>::infinity();
        std::vector<std::size_t> indices;
        for (const auto& point : diagram.of(group.deformers, indices)) least = std::min(least, point.cost);
        if (!indices.empty()) first.emplace_back(least, group.words);
    }
    std::sort(first.begin(), first.end());
    if (first.size() < 3) return "";
    return fmt::format("below {} a frame only {} and {} are there; {} is the next", ms_text(first[2].first), first[0].second,
                       first[1].second, first[2].second);
}

// Stretches of the front that belong to one group.
std::vector<std::string> who_is_nearest(const Diagram& diagram)
{
    const std::vector<const DiagramPoint*> front = front_of(diagram);
    std::vector<std::string> lines;
    for (std::size_t begin = 0; begin < front.size();) {
        const std::string& group = group_of(front[begin]->deformer).words;
        std::size_t end = begin;
        while (end < front.size() && group_of(front[end]->deformer).words == group) ++end;
        const DiagramPoint &from = *front[begin], &to = *front[end - 1];
        std::string error = fmt::format("{:.1f} %", from.error_pct);
        if (end > begin + 1) error += fmt::format(" to {:.1f} % at {}", to.error_pct, ms_text(to.ms));
        lines.push_back(fmt::format("from {} {} is nearest: {} off ({})", ms_text(from.ms), group, error, to.words()));
        begin = end;
    }
    return lines;
}

std::string who_passes(const Diagram& diagram, const DeformerGroup& one, const DeformerGroup& other)
{
    std::vector<std::size_t> of_one, of_other;
    const auto ones = diagram.of(one.deformers, of_one), others = diagram.of(other.deformers, of_other);
    if (ones.empty() || others.empty()) return "";
    const auto crossing = analysis::nearer_from(ones, others);
    if (!crossing) return fmt::format("{} does not stay nearer than {} however long it takes", one.words, other.words);
    const DiagramPoint& point = diagram.points[of_one[crossing->one]];
    const std::string when = crossing->from_the_start ? "from the first" : fmt::format("from {} on", ms_text(crossing->from));
    return fmt::format("{} is nearer than {} {} ({}: {:.1f} %)", one.words, other.words, when, point.setting, point.error_pct);
}

const DeformerGroup& group_named(const std::string& words)
{
    return *std::find_if(deformer_groups().begin(), deformer_groups().end(), [&](const auto& group) { return group.words == words; });
}

// Delta mush, which is geometry alone, against PBS and XPBD within the time of `whose`.
std::string is_physics_worth_it(const Diagram& diagram, double budget_ms, const std::string& whose)
{
    const DiagramPoint *mush = best_of(diagram, group_named("delta mush"), budget_ms),
                       *pbs = best_of(diagram, group_named("PBS"), budget_ms), *xpbd = best_of(diagram, group_named("XPBD"), budget_ms);
    const auto told = [](const DiagramPoint* point) { return point ? fmt::format("{:.1f} % off", point->error_pct) : "not so quick"; };
    std::string text =
        fmt::format("within the {} of {}: delta mush {}, PBS {}, XPBD {}", ms_text(budget_ms), whose, told(mush), told(pbs), told(xpbd));
    if (!mush || (!pbs && !xpbd)) return text;
    const double none = std::numeric_limits<double>::infinity();
    const double physics_pct = std::min(pbs ? pbs->error_pct : none, xpbd ? xpbd->error_pct : none);
    const double gain_pct = 100.0 * (1.0 - physics_pct / mush->error_pct);
    text += fmt::format("; the physics {} {:.0f} % {} the error of geometry alone", gain_pct > 0.0 ? "takes" : "adds", std::abs(gain_pct),
                        gain_pct > 0.0 ? "off" : "to");
    if (!mush->beside_pct || !pbs || !pbs->beside_pct) return text;
    return text + fmt::format(" (from the second solution: delta mush {:.1f}, PBS {:.1f} %)", *mush->beside_pct, *pbs->beside_pct);
}

std::string what_is_undecided(const Diagram& diagram)
{
    if (!diagram.reference_error_pct) return fmt::format("the reference {} has no error bar here", diagram.reference);
    const auto below =
        std::count_if(diagram.points.begin(), diagram.points.end(), [](const auto& point) { return point.below_reference_error; });
    const std::string ms = diagram.reference_ms ? fmt::format(" takes {} and", ms_text(*diagram.reference_ms)) : "";
    const std::string difference =
        diagram.reference_difference_pct ? fmt::format(" ({:.1f} % from the solution beside it)", *diagram.reference_difference_pct) : "";
    return fmt::format("the reference {}{} may itself be up to {:.1f} % off{}: {} of {} points lie below that", diagram.reference, ms,
                       *diagram.reference_error_pct, difference, below, diagram.points.size());
}

}  // namespace

std::vector<std::string> findings(const Diagram& diagram)
{
    if (diagram.points.empty()) return {"no reference was reached: there is no error to show"};
    std::vector<std::string> lines = {who_is_quickest(diagram)};
    for (const std::string& line : who_is_nearest(diagram)) lines.push_back(line);
    for (const auto& [one, other] : {std::pair{"PBS", "delta mush"}, {"PBS", "XPBD"}, {"linear FEM", "PBS"}, {"nonlinear FEM", "PBS"}})
        lines.push_back(who_passes(diagram, group_named(one), group_named(other)));
    for (const DiagramPoint& budget : budgets_of(diagram))
        lines.push_back(is_physics_worth_it(diagram, budget.ms, "PBS, " + budget.setting));
    lines.push_back(physics_text(diagram));
    lines.push_back(what_is_undecided(diagram));
    std::erase(lines, "");
    return lines;
}

std::string front_text(const Diagram& diagram)
{
    std::string text =
        fmt::format("     {}\n     {:>10} {:>21} {:>9}  {}\n", diagram.name, "ms a frame", "quartiles", "off [%]", "deformer");
    for (const DiagramPoint* point : front_of(diagram))
        text += fmt::format("     {:>10.4g} {:>10.4g} {:>10.4g} {:>8.2f}{} {}\n", point->ms, point->ms_q1, point->ms_q3, point->error_pct,
                            point->below_reference_error ? "*" : " ", point->words());
    return text;
}

std::string best_text(const std::vector<Diagram>& diagrams)
{
    std::size_t width = 25;
    for (const Diagram& diagram : diagrams) width = std::max(width, diagram.name.size());
    std::string text = fmt::format("     {:<{}}", "off [%] at best, after ms", width);
    for (const DeformerGroup& group : deformer_groups()) text += fmt::format(" {:>17}", group.words);
    text += fmt::format(" {:>14}\n", "reference off");
    for (const Diagram& diagram : diagrams) {
        text += fmt::format("     {:<{}}", diagram.name, width);
        for (const DeformerGroup& group : deformer_groups()) {
            const DiagramPoint* best = best_of(diagram, group, std::numeric_limits<double>::infinity());
            text += fmt::format(
                " {:>17}",
                best ? fmt::format("{:.1f}{} {}", best->error_pct, best->below_reference_error ? "*" : "", ms_text(best->ms)) : "");
        }
        const auto& bar_pct = diagram.reference_error_pct;
        text += fmt::format(" {:>14}\n", bar_pct ? fmt::format("up to {:.1f}", *bar_pct) : "not known");
    }
    return text;
}

std::string physics_text(const Diagram& diagram)
{
    const DiagramPoint* mush = best_of(diagram, group_named("delta mush"), std::numeric_limits<double>::infinity());
    return mush ? is_physics_worth_it(diagram, mush->ms, "delta mush at its best, " + mush->setting) : "";
}

}  // namespace experiments

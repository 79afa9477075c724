#include "experiments/studies/work_precision/wins.hpp"

#include "experiments/studies/work_precision/findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <tuple>

namespace experiments {
namespace {

bool is_evaluated_pose(const Diagram& diagram)
{
    return is_pose(diagram) && diagram.half == Half::evaluation;
}

bool has_points(const Diagram& diagram, const DeformerGroup& group)
{
    return best_of(diagram, group, std::numeric_limits<double>::infinity()) != nullptr;
}

// Greater is better. The lead is the error of the next group over that of the nearest one.
std::tuple<bool, double> merit_of(const Win& win)
{
    const bool is_decided = win.nearest->decision == analysis::PairDecision::decided;
    const double lead = win.next_error_pct ? *win.next_error_pct / win.nearest->point.error_pct : 0.0;
    return {is_decided, lead};
}

Win win_of(const std::vector<Diagram>& diagrams, const DeformerGroup& group)
{
    Win best{group.key};
    for (const Diagram& diagram : diagrams) {
        if (!is_evaluated_pose(diagram)) continue;
        for (const double budget_ms : budgets_ms) {
            const std::vector<BudgetRow> ranked = best_within(diagram, budget_ms);
            if (ranked.empty() || ranked[0].group != group.key) continue;
            Win here{group.key, ranked[0]};
            if (ranked.size() > 1) here.next = ranked[1].group, here.next_error_pct = ranked[1].point.error_pct;
            here.places = best.places + 1;
            if (best.nearest && merit_of(here) <= merit_of(best))
                best.places = here.places;
            else
                best = here;
        }
    }
    return best;
}

std::string decision_cell(const BudgetRow& row, const std::vector<DeformerGroup>& groups)
{
    if (!row.decision) return "it is the only one";
    if (*row.decision == analysis::PairDecision::decided) return "decided";
    std::string against;
    for (const DeformerGroup& group : groups)
        if (std::ranges::count(row.undecided_against, group.key) > 0) against += (against.empty() ? "" : ", ") + group.words;
    return "undecided against " + against;
}

}  // namespace

std::vector<Win> wins_of(const std::vector<Diagram>& diagrams)
{
    std::vector<Win> wins;
    for (const DeformerGroup& group : groups_of(diagrams))
        if (std::ranges::any_of(diagrams, [&](const Diagram& one) { return is_evaluated_pose(one) && has_points(one, group); }))
            wins.push_back(win_of(diagrams, group));
    return wins;
}

std::string wins_text(const std::vector<Diagram>& diagrams)
{
    const std::vector<DeformerGroup>& groups = groups_of(diagrams);
    const auto words_of_group = [&](const std::string& key) { return std::ranges::find(groups, key, &DeformerGroup::key)->words; };
    std::string budgets, rows;
    for (const double ms : budgets_ms)
        budgets += fmt::format("{}{:g}", budgets.empty() ? "" : ms == budgets_ms.back() ? " and " : ", ", ms);
    for (const Win& win : wins_of(diagrams)) {
        if (!win.nearest) {
            rows += fmt::format("| {} | none | | | | | | 0 |\n", words_of_group(win.group));
            continue;
        }
        const BudgetRow& row = *win.nearest;
        const std::string next = win.next ? fmt::format("{}: {:.1f}", words_of_group(*win.next), *win.next_error_pct) : "";
        rows += fmt::format("| {} | {} | {} | {:g} | {:.1f} | {} | {} | {} |\n", words_of_group(win.group), row.diagram,
                            analysis::recorded_name(row.comparison), row.budget_ms, row.point.error_pct, next, decision_cell(row, groups),
                            win.places);
    }
    if (rows.empty()) return "";
    return fmt::format(
               "## Where each deformer is nearest\n\nThe table shows where each group is nearest to the reference. Decided places come "
               "before undecided ones, then the largest lead over the next group counts. The budgets are {} ms per frame. `none`: another "
               "group is nearer in each pose within each budget.\n\n| group | case | comparison | within [ms] | error [%] | next [%] | "
               "decision | places |\n|---|---|---|---|---|---|---|---|\n",
               budgets) +
           rows + "\n";
}

}  // namespace experiments

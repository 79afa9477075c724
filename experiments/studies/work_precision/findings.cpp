#include "experiments/studies/work_precision/findings.hpp"

#include "experiments/studies/work_precision/diagram_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace experiments {
namespace {

std::vector<const DiagramPoint*> front_of(const Diagram& diagram)
{
    std::vector<analysis::WorkPrecision> all;
    for (const DiagramPoint& point : diagram.points) all.push_back({point.ms, point.error_pct});
    std::vector<const DiagramPoint*> front;
    for (const std::size_t on_front : analysis::pareto_front(all)) front.push_back(&diagram.points[on_front]);
    return front;
}

// The two fastest groups, and the time from which on there is a third one.
std::string who_is_quickest(const Diagram& diagram)
{
    std::vector<std::pair<double, std::string>> first;  // the least time of each group
    for (const DeformerGroup& group : diagram.groups) {
        double least = std::numeric_limits<double>::infinity();
        std::vector<std::size_t> indices;
        for (const auto& point : diagram.of(group.deformers, indices)) least = std::min(least, point.cost);
        if (!indices.empty()) first.emplace_back(least, group.words);
    }
    std::sort(first.begin(), first.end());
    if (first.size() < 3) return "";
    return fmt::format("below {} per frame there are only {} and {}; {} is next", ms_text(first[2].first), first[0].second, first[1].second,
                       first[2].second);
}

// The best points of both, at any time.
std::string who_stays_behind(const Diagram& diagram, const DeformerGroup& one, const DeformerGroup& other)
{
    const double any_ms = std::numeric_limits<double>::infinity();
    const DiagramPoint *behind = best_of(diagram, one, any_ms), *nearer = best_of(diagram, other, any_ms);
    return fmt::format("{} is not nearer than {} from any time on (least errors {:.1f} and {:.1f} %){}", one.words, other.words,
                       behind->error_pct, nearer->error_pct, decision_on(diagram, *nearer, *behind).remark());
}

std::string who_passes(const Diagram& diagram, const DeformerGroup& one, const DeformerGroup& other)
{
    std::vector<std::size_t> of_one, of_other;
    const auto ones = diagram.of(one.deformers, of_one), others = diagram.of(other.deformers, of_other);
    if (ones.empty() || others.empty()) return "";
    const auto crossing = analysis::nearer_from(ones, others);
    if (!crossing) return who_stays_behind(diagram, one, other);
    const DiagramPoint& point = diagram.points[of_one[crossing->one]];
    const std::string when = crossing->from_the_start ? "at all times" : fmt::format("from {} on", ms_text(crossing->from));
    return fmt::format("{} is nearer than {} {} ({}: {:.1f} %){}", one.words, other.words, when, text_of(point.key), point.error_pct,
                       decision_from(diagram, one, other, crossing->from).value_or(Decision{}).remark());
}

// The nearest group within a budget, and the next one.
std::string who_is_nearest(const Diagram& diagram, double budget_ms)
{
    const std::vector<BudgetRow> ranked = best_within(diagram, budget_ms);
    if (ranked.empty()) return fmt::format("within {} per frame there is no deformer", ms_text(budget_ms));
    const auto described = [&](const BudgetRow& row) {
        const auto group = std::ranges::find(diagram.groups, row.group, &DeformerGroup::key);
        return fmt::format("{} ({}: {:.1f} %)", group->words, text_of(row.point.key), row.point.error_pct);
    };
    std::string text = fmt::format("within {} per frame {} is nearest", ms_text(budget_ms), described(ranked[0]));
    if (ranked.size() == 1) return text + ", as the only one";
    const RankDecision decision = rank_decision(diagram, ranked, 0).value();
    text += fmt::format("; next is {}", described(ranked[1]));
    const int references = decision.worst.references;
    if (!decision.worst.is_decided()) return text + decision.remark(diagram);
    return text + fmt::format(" [decided by {} {}]", references, references == 1 ? "reference" : "references, which agree");
}

// Delta mush, which is pure geometry, against PBS and XPBD within a budget.
std::string is_physics_worth_it(const Diagram& diagram, double budget_ms)
{
    const DiagramPoint *mush = best_of(diagram, group_named("delta_mush"), budget_ms),
                       *pbs = best_of(diagram, group_named("pbs"), budget_ms), *xpbd = best_of(diagram, group_named("xpbd"), budget_ms);
    if (!mush || (!pbs && !xpbd)) return "";
    const DiagramPoint& physics = pbs && (!xpbd || pbs->error_pct <= xpbd->error_pct) ? *pbs : *xpbd;
    const double gain_pct = 100.0 * (1.0 - physics.error_pct / mush->error_pct);
    const Decision decision = gain_pct > 0.0 ? decision_on(diagram, physics, *mush) : decision_on(diagram, *mush, physics);
    return fmt::format("within {} the physics of {} {} the error of delta mush, geometry alone, by {:.0f} %{}", ms_text(budget_ms),
                       group_of(physics.key.deformer).words, gain_pct > 0.0 ? "reduces" : "increases", std::abs(gain_pct),
                       decision.remark());
}

std::string how_certain_the_reference_is(const Diagram& diagram)
{
    const std::string ms = diagram.reference_ms ? fmt::format(", which takes {},", ms_text(*diagram.reference_ms)) : "";
    if (!diagram.reference_error_pct) return fmt::format("the error of the reference ({}){} is not known", diagram.reference, ms);
    const auto below =
        std::ranges::count_if(diagram.points, [&](const auto& point) { return point.error_pct <= *diagram.reference_error_pct; });
    return fmt::format("the reference ({}){} has an error of at most {:.2g} %, and {} of {} points lie within that", diagram.reference, ms,
                       *diagram.reference_error_pct, below, diagram.points.size());
}

// The law of the reference with order 1, on the case's own tets and on tets cut into eight.
std::string what_refinement_does(const Diagram& diagram)
{
    const auto with = [&](bool refined) {
        return std::ranges::find_if(diagram.points, [&](const DiagramPoint& point) {
            const SettingKey& key = point.key;
            return key.deformer == "fem_neo_hookean" && key.element_order == 1 && key.refined == refined && !key.wanted_vertices;
        });
    };
    const auto own = with(false), refined = with(true);
    if (own == diagram.points.end() || refined == diagram.points.end()) return "";
    return fmt::format(
        "one refinement: neo-Hookean flesh of order 1 has an error of {:.1f} % on the case's own tets and of {:.1f} % on tets "
        "cut into eight",
        own->error_pct, refined->error_pct);
}

std::string what_is_left_out(const Diagram& diagram)
{
    if (diagram.masked_share_pct == 0.0) return "";
    return fmt::format("{:.2g} % of the volume, where the reference overlaps itself, is left out: contact is not modelled",
                       diagram.masked_share_pct);
}

}  // namespace

std::string ms_text(double ms)
{
    return ms < 100.0 ? fmt::format("{:.2g} ms", ms) : fmt::format("{:.0f} ms", ms);
}

std::vector<std::string> findings(const Diagram& diagram)
{
    if (diagram.points.empty()) return {"no reference was reached: there is no error to show"};
    std::vector<std::string> lines;
    for (const double budget_ms : budgets_ms) lines.push_back(who_is_nearest(diagram, budget_ms));
    lines.push_back(who_is_quickest(diagram));
    for (const auto& [one, other] : {std::pair{"pbs", "delta_mush"},
                                     {"pbs", "xpbd"},
                                     {"quasi_newton", "pbs"},
                                     {"quasi_newton", "delta_mush"},
                                     {"vbd", "pbs"},
                                     {"vbd", "delta_mush"},
                                     {"linear_fem", "pbs"},
                                     {"nonlinear_fem", "pbs"}})
        lines.push_back(who_passes(diagram, group_named(one), group_named(other)));
    for (const DeformerGroup& group : diagram.groups)
        if (group.is_external) lines.push_back(who_passes(diagram, group, group_named("pbs")));
    for (const double budget_ms : {1.0, 10.0}) lines.push_back(is_physics_worth_it(diagram, budget_ms));
    lines.push_back(how_certain_the_reference_is(diagram));
    lines.push_back(what_refinement_does(diagram));
    lines.push_back(what_is_left_out(diagram));
    std::erase(lines, "");
    return lines;
}

std::string front_text(const Diagram& diagram)
{
    const auto known = [](const std::optional<double>& ms) { return ms ? fmt::format("{:.4g}", *ms) : ""; };
    std::string text =
        fmt::format("     {}\n     {:>12} {:>21} {:>9}  {}\n", diagram.name, "ms per frame", "quartiles", "error [%]", "deformer");
    for (const DiagramPoint* point : front_of(diagram))
        text += fmt::format("     {:>12.4g} {:>10} {:>10} {:>8.2f}{} {}\n", point->ms, known(point->ms_q1), known(point->ms_q3),
                            point->error_pct, point->below_reference_error ? "*" : " ", text_of(point->key));
    return text;
}

}  // namespace experiments

#include "experiments/studies/work_precision/diagram_tables.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace experiments {
namespace {

using analysis::Columns;
using analysis::within;

const Columns<DiagramPoint> quartile_columns = {{"ms_q1", &DiagramPoint::ms_q1, "ms", "its lower quartile"},
                                                {"ms_q3", &DiagramPoint::ms_q3, "ms", "its upper quartile"}};
const Columns<DiagramPoint> point_error_columns = {measures().front()};
const Columns<DiagramPoint> below_columns = {
    {"below_reference_error", &DiagramPoint::below_reference_error, "", "the error is not above the reference's own bound"}};

const char* const comparison_meaning = "packed_f32 or plain_f64";
const char* const decision_meaning = "decided, reference_error (a reference does not decide) or models_disagree";

struct FrontRow {
    Comparison comparison;
    std::string diagram, measure, front;
    DiagramPoint point;
    double value = 0.0;
    std::optional<double> reference_error_pct;
    std::optional<analysis::PairDecision> decision = {};
    std::string reason = {};
};
const Columns<FrontRow> front_columns =
    Columns<FrontRow>{{"comparison", &FrontRow::comparison, "", comparison_meaning},
                      {"case", &FrontRow::diagram, "", "name of the case's run, or of the mean over several"},
                      {"measure", &FrontRow::measure, "", "what the front is the best of: a column of points.csv"},
                      {"front", &FrontRow::front, "", "whose front it is: a deformer's, or all"}} +
    within(&FrontRow::point, diagram_point_columns() + quartile_columns) +
    Columns<FrontRow>{{"value", &FrontRow::value, "", "the point's value of the measure, in the measure's unit"}} +
    within(&FrontRow::point, point_error_columns + below_columns) +
    Columns<FrontRow>{
        {"reference_error_joint_pct", &FrontRow::reference_error_pct, "%", "bound of the reference's own error at the joints"},
        {"decision", &FrontRow::decision, "",
         std::string("front all by error_joint_pct alone: whether it is nearer than any other group within its time: ") + decision_meaning},
        {"reason", &FrontRow::reason, "", "why it is not decided, for readers"}};

struct CrossingRow {
    Comparison comparison;
    std::string diagram, deformer, other, outcome = "never";
    std::optional<double> from_ms = {}, from_ms_q1 = {}, from_ms_q3 = {};
    std::optional<SettingKey> setting = {};
    std::optional<double> error_pct = {}, other_error_pct = {}, reference_error_pct = {};
    std::optional<analysis::PairDecision> decision = {};
    std::string reason = {};
};
const Columns<CrossingRow> crossing_columns =
    Columns<CrossingRow>{{"comparison", &CrossingRow::comparison, "", comparison_meaning},
                         {"case", &CrossingRow::diagram, "", "name of the case's run, or of the mean over several"},
                         {"deformer", &CrossingRow::deformer, "", "key of a group of deformers"},
                         {"other", &CrossingRow::other, "", "another group"},
                         {"outcome", &CrossingRow::outcome, "",
                          "whether the first group's best is nearer to the reference: always, from some time on, never"},
                         {"from_ms", &CrossingRow::from_ms, "ms", "time per frame from which on it is nearer"},
                         {"from_ms_q1", &CrossingRow::from_ms_q1, "ms", "lower quartile of the time of the point that is nearer"},
                         {"from_ms_q3", &CrossingRow::from_ms_q3, "ms", "its upper quartile"}} +
    within(&CrossingRow::setting, Columns<SettingKey>{{"point", &SettingKey::deformer, "", "deformer of that point"}} + setting_columns()) +
    Columns<CrossingRow>{
        {"error_joint_pct", &CrossingRow::error_pct, "%", "error of that point"},
        {"other_error_joint_pct", &CrossingRow::other_error_pct, "%", "least error of the other group within that time"},
        {"reference_error_joint_pct", &CrossingRow::reference_error_pct, "%", "bound of the reference's own error at the joints"},
        {"decision", &CrossingRow::decision, "", std::string("the worst from that time on: ") + decision_meaning},
        {"reason", &CrossingRow::reason, "", "why it is not decided, for readers"}};

}  // namespace

const Columns<BudgetRow> budget_columns =
    Columns<BudgetRow>{{"comparison", &BudgetRow::comparison, "", comparison_meaning},
                       {"case", &BudgetRow::diagram, "", "name of the case's run, or of the mean over several"},
                       {"budget_ms", &BudgetRow::budget_ms, "ms", "time per frame"},
                       {"rank", &BudgetRow::rank, "", "1: the group that is nearest to the reference within the budget"},
                       {"group", &BudgetRow::group, "", "key of a group of deformers"}} +
    within(&BudgetRow::point, diagram_point_columns() + point_error_columns) +
    Columns<BudgetRow>{
        {"decision", &BudgetRow::decision, "", std::string("whether it is nearer than every group of a later rank: ") + decision_meaning},
        {"undecided_against", &BudgetRow::undecided_against, "", "keys of the groups against which it is undecided"},
        {"reason", &BudgetRow::reason, "", "why it is not decided, for readers"}};

namespace {

std::optional<double> known(double value)
{
    return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

const std::string all_name = "all";

std::vector<std::string> all_deformers(const Diagram& diagram)
{
    std::vector<std::string> all;
    for (const DeformerGroup& group : diagram.groups) all.insert(all.end(), group.deformers.begin(), group.deformers.end());
    return all;
}

void add_front(std::vector<FrontRow>& rows, const Diagram& diagram, const std::string& measure, const std::string& name,
               const std::vector<std::string>& deformers)
{
    std::vector<std::size_t> indices;
    for (const std::size_t on_front : analysis::pareto_front(diagram.of(deformers, indices, measure))) {
        const DiagramPoint& point = diagram.points[indices[on_front]];
        FrontRow& row = rows.emplace_back(
            FrontRow{diagram.comparison, diagram.key, measure, name, point, value_of(point, measure), diagram.reference_error_pct});
        if (name != all_name || measure != measures().front().name) continue;
        const std::optional<RankDecision> decision = rank_decision(diagram, best_within(diagram, point.ms), 0);
        if (!decision) continue;
        row.decision = decision->worst.decision;
        row.reason = decision->worst.reason;
    }
}

void add_crossing(std::vector<CrossingRow>& rows, const Diagram& diagram, const DeformerGroup& one, const DeformerGroup& other)
{
    std::vector<std::size_t> of_one, of_other;
    const auto ones = diagram.of(one.deformers, of_one), others = diagram.of(other.deformers, of_other);
    if (ones.empty() || others.empty()) return;
    CrossingRow& row = rows.emplace_back(CrossingRow{diagram.comparison, diagram.key, one.key, other.key});
    row.reference_error_pct = diagram.reference_error_pct;
    const auto crossing = analysis::nearer_from(ones, others);
    if (!crossing) return;
    const DiagramPoint& point = diagram.points[of_one[crossing->one]];
    row.outcome = crossing->from_the_start ? "always" : "from";
    row.from_ms = crossing->from;
    row.from_ms_q1 = point.ms_q1;
    row.from_ms_q3 = point.ms_q3;
    row.setting = point.key;
    row.error_pct = point.error_pct;
    row.other_error_pct = known(crossing->other_error);
    const std::optional<Decision> decision = decision_from(diagram, one, other, crossing->from);
    if (!decision) return;
    row.decision = decision->decision;
    row.reason = decision->reason;
}

}  // namespace

analysis::CsvTable fronts_table(const std::vector<Diagram>& diagrams)
{
    std::vector<FrontRow> rows;
    for (const Diagram& diagram : diagrams)
        for (const std::string& measure : measures().names()) {
            add_front(rows, diagram, measure, all_name, all_deformers(diagram));
            for (const std::string& deformer : all_deformers(diagram)) add_front(rows, diagram, measure, deformer, {deformer});
        }
    return table_of(front_columns, rows);
}

analysis::CsvTable crossings_table(const std::vector<Diagram>& diagrams)
{
    std::vector<CrossingRow> rows;
    for (const Diagram& diagram : diagrams)
        for (const DeformerGroup& one : diagram.groups)
            for (const DeformerGroup& other : diagram.groups)
                if (&one != &other) add_crossing(rows, diagram, one, other);
    return table_of(crossing_columns, rows);
}

std::vector<BudgetRow> best_within(const Diagram& diagram, double budget_ms)
{
    std::vector<BudgetRow> rows;
    for (const DeformerGroup& group : diagram.groups)
        if (const DiagramPoint* point = best_of(diagram, group, budget_ms))
            rows.push_back({diagram.comparison, diagram.key, budget_ms, 0, group.key, *point});
    std::ranges::stable_sort(rows, {}, [](const BudgetRow& row) { return row.point.error_pct; });
    for (std::size_t i = 0; i < rows.size(); ++i) {
        rows[i].rank = static_cast<int>(i + 1);
        const std::optional<RankDecision> decision = rank_decision(diagram, rows, i);
        if (!decision) break;
        rows[i].decision = decision->worst.decision;
        rows[i].reason = decision->worst.reason;
        rows[i].undecided_against = decision->undecided;
    }
    return rows;
}

std::string RankDecision::remark(const Diagram& diagram) const
{
    if (worst.is_decided()) return "";
    std::vector<std::string> words;
    for (const std::string& key : undecided) words.push_back(std::ranges::find(diagram.groups, key, &DeformerGroup::key)->words);
    return fmt::format(" [undecided against {}: {}]", fmt::join(words, ", "), worst.reason);
}

std::optional<RankDecision> rank_decision(const Diagram& diagram, const std::vector<BudgetRow>& ranked, std::size_t place)
{
    std::optional<RankDecision> all;
    for (std::size_t i = place + 1; i < ranked.size(); ++i) {
        const Decision decision = decision_on(diagram, ranked[place].point, ranked[i].point);
        if (!all) all = RankDecision{decision};
        if (decision.decision > all->worst.decision) all->worst = decision;
        if (!decision.is_decided()) all->undecided.push_back(ranked[i].group);
    }
    return all;
}

std::vector<BudgetRow> best_within(const std::vector<Diagram>& diagrams)
{
    std::vector<BudgetRow> rows;
    for (const Diagram& diagram : diagrams)
        for (const double budget_ms : budgets_ms)
            for (BudgetRow& row : best_within(diagram, budget_ms))
                if (diagram.poses > 1 || row.rank <= ranks_of_a_pose) rows.push_back(std::move(row));
    return rows;
}

}  // namespace experiments

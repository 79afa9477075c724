#include "experiments/studies/work_precision/diagram_tables.hpp"

#include "experiments/studies/work_precision/certainty.hpp"

#include <fmt/format.h>

#include <cmath>

namespace experiments {
namespace {

using analysis::Columns;
using analysis::within;

const Columns<SettingKey> point_deformer_columns = {{"deformer", &SettingKey::deformer, "", "name of the deformer"}};
const Columns<DiagramPoint> timed_columns =
    within(&DiagramPoint::key, point_deformer_columns) + within(&DiagramPoint::key, setting_columns()) +
    Columns<DiagramPoint>{{"ms_median", &DiagramPoint::ms, "ms", "median of the processor time per frame"}};
const Columns<DiagramPoint> quartile_columns = {{"ms_q1", &DiagramPoint::ms_q1, "ms", "its lower quartile"},
                                                {"ms_q3", &DiagramPoint::ms_q3, "ms", "its upper quartile"}};
const Columns<DiagramPoint> point_error_columns = {measures().front()};
const Columns<DiagramPoint> below_columns = {
    {"below_reference_error", &DiagramPoint::below_reference_error, "", "the error is not above the reference's own bound"}};

struct FrontRow {
    std::string diagram, measure, front;
    DiagramPoint point;
    double value = 0.0;
    std::optional<double> reference_error_pct;
};
const Columns<FrontRow> front_columns =
    Columns<FrontRow>{{"case", &FrontRow::diagram, "", "name of the case's run, or of the mean over several"},
                      {"measure", &FrontRow::measure, "", "what the front is the best of: a column of points.csv"},
                      {"front", &FrontRow::front, "", "whose front it is: a deformer's, or all"}} +
    within(&FrontRow::point, timed_columns + quartile_columns) +
    Columns<FrontRow>{{"value", &FrontRow::value, "", "the point's value of the measure, in the measure's unit"}} +
    within(&FrontRow::point, point_error_columns + below_columns) +
    Columns<FrontRow>{
        {"reference_error_joint_pct", &FrontRow::reference_error_pct, "%", "bound of the reference's own error at the joints"}};

struct CrossingRow {
    std::string diagram, deformer, other, outcome = "never";
    std::optional<double> from_ms = {}, from_ms_q1 = {}, from_ms_q3 = {};
    std::optional<SettingKey> setting = {};
    std::optional<double> error_pct = {}, other_error_pct = {}, reference_error_pct = {};
    std::optional<bool> decided = {};
};
const Columns<CrossingRow> crossing_columns =
    Columns<CrossingRow>{{"case", &CrossingRow::diagram, "", "name of the case's run, or of the mean over several"},
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
        {"decided", &CrossingRow::decided, "", "the two errors differ by more than twice that bound, from that time on"}};

}  // namespace

const Columns<BudgetRow> budget_columns =
    Columns<BudgetRow>{
        {"case", &BudgetRow::diagram, "", "name of the case's run, or of the mean over several"},
        {"budget_iterations", &BudgetRow::budget_iterations, "", "PBS with its defaults and these iterations has the budget"},
        {"budget_ms", &BudgetRow::budget_ms, "ms", "that time per frame"},
        {"group", &BudgetRow::group, "", "key of a group of deformers"}} +
    within(&BudgetRow::point, timed_columns + point_error_columns);

namespace {

std::optional<double> known(double value)
{
    return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::vector<std::string> all_deformers()
{
    std::vector<std::string> all;
    for (const DeformerGroup& group : deformer_groups()) all.insert(all.end(), group.deformers.begin(), group.deformers.end());
    return all;
}

void add_front(std::vector<FrontRow>& rows, const Diagram& diagram, const std::string& measure, const std::string& name,
               const std::vector<std::string>& deformers)
{
    std::vector<std::size_t> indices;
    for (const std::size_t on_front : analysis::pareto_front(diagram.of(deformers, indices, measure))) {
        const DiagramPoint& point = diagram.points[indices[on_front]];
        rows.push_back({diagram.key, measure, name, point, value_of(point, measure), diagram.reference_error_pct});
    }
}

void add_crossing(std::vector<CrossingRow>& rows, const Diagram& diagram, const DeformerGroup& one, const DeformerGroup& other)
{
    std::vector<std::size_t> of_one, of_other;
    const auto ones = diagram.of(one.deformers, of_one), others = diagram.of(other.deformers, of_other);
    if (ones.empty() || others.empty()) return;
    CrossingRow& row = rows.emplace_back(CrossingRow{diagram.key, one.key, other.key});
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
    row.decided = is_certain_from(diagram, one, other, crossing->from);
}

}  // namespace

analysis::CsvTable fronts_table(const std::vector<Diagram>& diagrams)
{
    std::vector<FrontRow> rows;
    for (const Diagram& diagram : diagrams)
        for (const std::string& measure : measures().names()) {
            add_front(rows, diagram, measure, "all", all_deformers());
            for (const std::string& deformer : all_deformers()) add_front(rows, diagram, measure, deformer, {deformer});
        }
    return table_of(front_columns, rows);
}

analysis::CsvTable crossings_table(const std::vector<Diagram>& diagrams)
{
    std::vector<CrossingRow> rows;
    for (const Diagram& diagram : diagrams)
        for (const DeformerGroup& one : deformer_groups())
            for (const DeformerGroup& other : deformer_groups())
                if (&one != &other) add_crossing(rows, diagram, one, other);
    return table_of(crossing_columns, rows);
}

std::vector<BudgetRow> equal_cost(const std::vector<Diagram>& diagrams)
{
    std::vector<BudgetRow> rows;
    for (const Diagram& diagram : diagrams)
        for (const DiagramPoint& budget : budgets_of(diagram))
            for (const DeformerGroup& group : deformer_groups())
                if (const DiagramPoint* point = best_of(diagram, group, budget.ms))
                    rows.push_back({diagram.key, budget.key.iterations, budget.ms, group.key, *point});
    return rows;
}

}  // namespace experiments

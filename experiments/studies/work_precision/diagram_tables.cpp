#include "experiments/studies/work_precision/diagram_tables.hpp"

#include "experiments/studies/work_precision/certainty.hpp"

#include <fmt/format.h>

#include <cmath>

namespace experiments {
namespace {

using Cell = analysis::CsvTable::Cell;

Cell known(double value)
{
    return std::isfinite(value) ? Cell(value) : Cell(std::nullopt);
}

Cell known(const std::optional<double>& value)
{
    return value ? Cell(*value) : Cell(std::nullopt);
}

std::vector<std::string> all_deformers()
{
    std::vector<std::string> all;
    for (const DeformerGroup& group : deformer_groups()) all.insert(all.end(), group.deformers.begin(), group.deformers.end());
    return all;
}

void add_front(analysis::CsvTable& table, const Diagram& diagram, const std::string& measure, const std::string& name,
               const std::vector<std::string>& deformers)
{
    std::vector<std::size_t> indices;
    for (const std::size_t on_front : analysis::pareto_front(diagram.of(deformers, indices, measure))) {
        const DiagramPoint& point = diagram.points[indices[on_front]];
        table.add_row({diagram.name, measure, name, point.deformer, point.setting, point.ms, known(point.ms_q1), known(point.ms_q3),
                       value_of(point, measure), point.error_pct, int(point.below_reference_error), known(diagram.reference_error_pct)});
    }
}

void add_crossing(analysis::CsvTable& table, const Diagram& diagram, const DeformerGroup& one, const DeformerGroup& other)
{
    std::vector<std::size_t> of_one, of_other;
    const auto ones = diagram.of(one.deformers, of_one), others = diagram.of(other.deformers, of_other);
    if (ones.empty() || others.empty()) return;
    const auto crossing = analysis::nearer_from(ones, others);
    std::vector<Cell> row = {diagram.name, one.words, other.words};
    const auto add = [&](const std::vector<Cell>& cells) { row.insert(row.end(), cells.begin(), cells.end()); };
    if (crossing) {
        const DiagramPoint& point = diagram.points[of_one[crossing->one]];
        const std::optional<Certainty> certainty = certainty_from(diagram, one, other, crossing->from);
        const auto is = [&](Certainty least) {
            return certainty && *certainty != Certainty::not_known ? Cell(int(*certainty >= least)) : Cell(std::nullopt);
        };
        add({crossing->from_the_start ? "always" : "from", crossing->from, known(point.ms_q1), known(point.ms_q3), point.setting,
             point.error_pct, known(crossing->other_error), known(diagram.reference_error_pct), is(Certainty::told_apart),
             is(Certainty::both_solutions)});
    } else {
        add({"never", std::nullopt, std::nullopt, std::nullopt, "", std::nullopt, std::nullopt, known(diagram.reference_error_pct),
             std::nullopt, std::nullopt});
    }
    table.add_row(row);
}

}  // namespace

analysis::CsvTable fronts_table(const std::vector<Diagram>& diagrams)
{
    analysis::CsvTable table({"case", "measure", "front", "deformer", "setting", "ms_median", "ms_q1", "ms_q3", "value", "error_joint_pct",
                              "below_reference_error", "reference_error_joint_pct"});
    for (const Diagram& diagram : diagrams)
        for (const std::string& measure : measures()) {
            add_front(table, diagram, measure, "all", all_deformers());
            for (const std::string& deformer : all_deformers()) add_front(table, diagram, measure, deformer, {deformer});
        }
    return table;
}

analysis::CsvTable crossings_table(const std::vector<Diagram>& diagrams)
{
    analysis::CsvTable table({"case", "deformer", "other", "outcome", "from_ms", "from_ms_q1", "from_ms_q3", "setting", "error_joint_pct",
                              "other_error_joint_pct", "reference_error_joint_pct", "told_apart", "holds_beside"});
    for (const Diagram& diagram : diagrams)
        for (const DeformerGroup& one : deformer_groups())
            for (const DeformerGroup& other : deformer_groups())
                if (&one != &other) add_crossing(table, diagram, one, other);
    return table;
}

analysis::CsvTable equal_cost_table(const std::vector<Diagram>& diagrams)
{
    analysis::CsvTable table({"case", "budget_of", "budget_ms", "group", "deformer", "setting", "ms_median", "error_joint_pct"});
    for (const Diagram& diagram : diagrams)
        for (const DiagramPoint& budget : budgets_of(diagram))
            for (const DeformerGroup& group : deformer_groups())
                if (const DiagramPoint* point = best_of(diagram, group, budget.ms))
                    table.add_row({diagram.name, budget.words(), budget.ms, group.words, point->deformer, point->setting, point->ms,
                                   point->error_pct});
    return table;
}

}  // namespace experiments

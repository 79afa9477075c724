#include "experiments/studies/work_precision/goal.hpp"

#include "experiments/studies/work_precision/data_profile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace experiments {
namespace {

using analysis::Columns;
using analysis::within;

// The reference's law with linear elements on the case's own tets.
std::optional<double> error_of_linear_elements(const Diagram& diagram)
{
    const auto found = std::ranges::find_if(diagram.points, [](const DiagramPoint& point) {
        const SettingKey& key = point.key;
        return key.deformer == "fem_neo_hookean" && key.element_order == 1 && !key.refined && !key.wanted_vertices;
    });
    return found == diagram.points.end() ? std::nullopt : std::optional(found->error_pct);
}

void add_rows(std::vector<GoalRow>& rows, const Diagram& diagram)
{
    GoalRow row{diagram.comparison, diagram.key, diagram.half, error_of_linear_elements(diagram)};
    const auto add = [&](GoalPoint which, const DiagramPoint* point) {
        if (!point) return;
        row.which = which;
        row.point = *point;
        row.reaches_goal = point->ms <= goal_ms && point->error_pct <= goal_pct;
        rows.push_back(row);
    };
    const DiagramPoint *nearest = nullptr, *fastest = nullptr;
    const auto by_error = [](const DiagramPoint& one) { return std::tuple(one.error_pct, one.ms); };
    for (const DiagramPoint& point : diagram.points) {
        if (point.ms <= goal_ms && (!nearest || by_error(point) < by_error(*nearest))) nearest = &point;
        if (point.error_pct <= goal_pct && (!fastest || point.ms < fastest->ms)) fastest = &point;
    }
    add(GoalPoint::nearest_within_time, nearest);
    add(GoalPoint::fastest_within_error, fastest);
}

std::string solved_table(const std::vector<Diagram>& diagrams, Comparison comparison)
{
    std::vector<std::string> bodies;
    for (const Diagram& diagram : diagrams)
        if (diagram.poses == 1 && std::ranges::find(bodies, diagram.pose.body) == bodies.end()) bodies.push_back(diagram.pose.body);
    std::string header = "| group |", line = "|---|", rows;
    for (const std::string& body : bodies) header += " " + body + " |", line += "---|";
    for (const DeformerGroup& group : deformer_groups()) {
        std::string cells;
        bool solves = false;
        for (const std::string& body : bodies) {
            const Solved solved = solved_within(diagrams, comparison, group, goal_pct, goal_ms, body, true);
            solves = solves || solved.solved > 0;
            cells += solved.poses ? fmt::format(" {} of {} |", solved.solved, solved.poses) : " |";
        }
        if (solves) rows += fmt::format("| {} |{}\n", group.words, cells);
    }
    if (rows.empty()) return fmt::format("No deformer has an error of at most {:g} % within {:g} ms.\n\n", goal_pct, goal_ms);
    return fmt::format("Poses solved to {:g} % within {:g} ms, the training poses included:\n\n", goal_pct, goal_ms) + header + "\n" +
           line + "\n" + rows + "\n";
}

std::string cells_of(const std::vector<GoalRow>& rows, const Diagram& diagram, GoalPoint which)
{
    const auto found = std::ranges::find_if(
        rows, [&](const GoalRow& row) { return row.comparison == diagram.comparison && row.diagram == diagram.key && row.which == which; });
    if (found == rows.end()) return " none | | |";
    return fmt::format(" {} | {:.2g} | {:.1f} |", text_of(found->point.key), found->point.ms, found->point.error_pct);
}

std::string row_table(const std::vector<Diagram>& diagrams, Comparison comparison)
{
    const std::vector<GoalRow> rows = goal_rows(diagrams);
    std::string text = fmt::format(
        "| case | linear elements on its own tets [%] | nearest within {0:g} ms | ms | error [%] | fastest within {1:g} % | ms | error [%] "
        "|\n"
        "|---|---|---|---|---|---|---|---|\n",
        goal_ms, goal_pct);
    for (const Diagram& diagram : diagrams) {
        if (diagram.comparison != comparison || !is_pose(diagram)) continue;
        const std::optional<double> linear_pct = error_of_linear_elements(diagram);
        text += fmt::format("| {}{} | {} |{}{}\n", diagram.key, diagram.half == Half::training ? " (training)" : "",
                            linear_pct ? fmt::format("{:.1f}", *linear_pct) : "", cells_of(rows, diagram, GoalPoint::nearest_within_time),
                            cells_of(rows, diagram, GoalPoint::fastest_within_error));
    }
    return text + "\n";
}

}  // namespace

const Columns<GoalRow> goal_columns =
    Columns<GoalRow>{{"comparison", &GoalRow::comparison, "", "packed_f32 or plain_f64"},
                     {"case", &GoalRow::diagram, "", "name of the case's run"},
                     {"half", &GoalRow::half, "", "training or evaluation"},
                     {"linear_elements_joint_pct", &GoalRow::linear_elements_pct, "%",
                      "error of the reference's law with linear elements on the case's own tets"},
                     {"point", &GoalRow::which, "", "nearest_within_time (3 ms) or fastest_within_error (5 %)"}} +
    within(&GoalRow::point, diagram_point_columns() + Columns<DiagramPoint>{measures().front()}) +
    Columns<GoalRow>{{"reaches_goal", &GoalRow::reaches_goal, "", "at most 5 % within 3 ms"}};

std::vector<GoalRow> goal_rows(const std::vector<Diagram>& diagrams)
{
    std::vector<GoalRow> rows;
    for (const Diagram& diagram : diagrams)
        if (is_pose(diagram)) add_rows(rows, diagram);
    return rows;
}

std::string goal_text(const std::vector<Diagram>& diagrams, Comparison comparison)
{
    return solved_table(diagrams, comparison) + row_table(diagrams, comparison);
}

}  // namespace experiments

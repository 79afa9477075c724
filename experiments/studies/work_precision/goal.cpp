#include "experiments/studies/work_precision/goal.hpp"

#include "experiments/studies/work_precision/data_profile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace experiments {
namespace {

using analysis::Columns;
using analysis::within;

// The reference's law with linear elements on the case's own tets, by Newton's method. Null where the diagram does not have it.
const DiagramPoint* linear_elements_of(const Diagram& diagram)
{
    const auto found = std::ranges::find_if(diagram.points, [](const DiagramPoint& point) {
        const SettingKey& key = point.key;
        return key.deformer == "fem_neo_hookean" && key.element_order == 1 && !key.refined && !key.wanted_vertices;
    });
    return found == diagram.points.end() ? nullptr : &*found;
}

// The least point by the order among those that fulfil the condition. Null where none does.
const DiagramPoint* least(const Diagram& diagram, auto fulfils, auto order)
{
    const DiagramPoint* found = nullptr;
    for (const DiagramPoint& point : diagram.points)
        if (fulfils(point) && (!found || order(point) < order(*found))) found = &point;
    return found;
}

const DiagramPoint* goal_point(const Diagram& diagram, GoalPoint which)
{
    const auto by_error = [](const DiagramPoint& one) { return std::tuple(one.error_pct, one.ms); };
    const auto by_time = [](const DiagramPoint& one) { return one.ms; };
    switch (which) {
        case GoalPoint::nearest_within_time:
            return least(
                diagram, [](const auto& point) { return point.ms <= goal_ms; }, by_error);
        case GoalPoint::fastest_within_error:
            return least(
                diagram, [](const auto& point) { return point.error_pct <= goal_pct; }, by_time);
        case GoalPoint::fastest_to_linear_elements:
            break;
    }
    const auto fulfils = [](const auto& point) { return point.to_linear_elements_pct && *point.to_linear_elements_pct <= solver_goal_pct; };
    return least(diagram, fulfils, by_time);
}

std::optional<GoalRow> goal_row(const Diagram& diagram, GoalPoint which)
{
    const DiagramPoint *point = goal_point(diagram, which), *linear = linear_elements_of(diagram);
    if (!point) return std::nullopt;
    GoalRow row{.comparison = diagram.comparison, .diagram = diagram.key, .half = diagram.half, .which = which, .point = *point};
    if (linear) row.linear_elements_pct = linear->error_pct, row.newton_ms = linear->ms;
    const bool of_solver = which == GoalPoint::fastest_to_linear_elements;
    row.reaches_goal = of_solver ? point->ms <= solver_goal_ms : point->ms <= goal_ms && point->error_pct <= goal_pct;
    return row;
}

std::string solved_table(const std::vector<Diagram>& diagrams, Comparison comparison)
{
    std::vector<std::string> bodies;
    for (const Diagram& diagram : diagrams)
        if (diagram.poses == 1 && std::ranges::find(bodies, diagram.pose.body) == bodies.end()) bodies.push_back(diagram.pose.body);
    std::string header = "| group |", line = "|---|", rows;
    for (const std::string& body : bodies) header += " " + body + " |", line += "---|";
    for (const DeformerGroup& group : groups_of(diagrams)) {
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

std::string text_of(const std::optional<double>& value)
{
    return value ? fmt::format("{:.2g}", *value) : "";
}

std::string cells_of(const Diagram& diagram, GoalPoint which)
{
    const DiagramPoint* point = goal_point(diagram, which);
    if (!point) return " none | | |";
    return fmt::format(" {} | {:.2g} | {:.1f} |", text_of(point->key), point->ms, point->error_pct);
}

std::string case_cell(const Diagram& diagram)
{
    return diagram.key + (diagram.half == Half::training ? " (training)" : "");
}

std::string error_table(const std::vector<const Diagram*>& poses)
{
    std::string text = fmt::format(
        "| case | linear elements on its own tets [%] | nearest within {0:g} ms | ms | error [%] | fastest within {1:g} % | ms | error [%] "
        "|\n|---|---|---|---|---|---|---|---|\n",
        goal_ms, goal_pct);
    for (const Diagram* pose : poses) {
        const DiagramPoint* linear = linear_elements_of(*pose);
        text += fmt::format("| {} | {} |{}{}\n", case_cell(*pose), linear ? fmt::format("{:.1f}", linear->error_pct) : "",
                            cells_of(*pose, GoalPoint::nearest_within_time), cells_of(*pose, GoalPoint::fastest_within_error));
    }
    return text + "\n";
}

std::string solver_table(const std::vector<const Diagram*>& poses)
{
    std::string rows;
    for (const Diagram* pose : poses) {
        const std::optional<GoalRow> row = goal_row(*pose, GoalPoint::fastest_to_linear_elements);
        if (!row) continue;
        rows += fmt::format("| {} | {} | {:.2g} | {} | {} |\n", case_cell(*pose), text_of(row->point.key), row->point.ms,
                            text_of(row->point.to_linear_elements_pct), row->newton_ms ? fmt::format("{:.0f}", *row->newton_ms) : "");
    }
    if (rows.empty()) return "";
    return fmt::format(
               "The solver alone: the fastest deformer that is within {:g} % of the reference's linear elements on the same tets, and the "
               "time of Newton's method for these elements. The goal is {:g} ms.\n\n| case | deformer | ms | distance [%] | Newton's "
               "method [ms] |\n|---|---|---|---|---|\n",
               solver_goal_pct, solver_goal_ms) +
           rows + "\n";
}

}  // namespace

const Columns<DiagramPoint> distance_columns = {
    {"to_linear_elements_joint_pct", &DiagramPoint::to_linear_elements_pct, "%", "distance at the joints from these linear elements"}};

const Columns<GoalRow> goal_columns =
    Columns<GoalRow>{
        {"comparison", &GoalRow::comparison, "", "packed_f32 or plain_f64"},
        {"case", &GoalRow::diagram, "", "name of the case's run"},
        {"half", &GoalRow::half, "", "training or evaluation"},
        {"linear_elements_joint_pct", &GoalRow::linear_elements_pct, "%",
         "error of the reference's law with linear elements on the case's own tets"},
        {"newton_ms", &GoalRow::newton_ms, "ms", "time per frame of Newton's method for them"},
        {"point", &GoalRow::which, "", "nearest_within_time (3 ms), fastest_within_error (5 %) or fastest_to_linear_elements (1 %)"}} +
    within(&GoalRow::point, diagram_point_columns() + Columns<DiagramPoint>{measures().front()}) +
    within(&GoalRow::point, distance_columns) +
    Columns<GoalRow>{{"reaches_goal", &GoalRow::reaches_goal, "", "at most 5 % within 3 ms; of fastest_to_linear_elements: 6 ms"}};

std::vector<GoalRow> goal_rows(const std::vector<Diagram>& diagrams)
{
    constexpr GoalPoint all[] = {GoalPoint::nearest_within_time, GoalPoint::fastest_within_error, GoalPoint::fastest_to_linear_elements};
    std::vector<GoalRow> rows;
    for (const Diagram& diagram : diagrams)
        for (const GoalPoint which : all)
            if (const auto row = is_pose(diagram) ? goal_row(diagram, which) : std::nullopt) rows.push_back(*row);
    return rows;
}

std::string goal_text(const std::vector<Diagram>& diagrams, Comparison comparison)
{
    std::vector<const Diagram*> poses;
    for (const Diagram& diagram : diagrams)
        if (diagram.comparison == comparison && is_pose(diagram)) poses.push_back(&diagram);
    return solved_table(diagrams, comparison) + error_table(poses) + solver_table(poses);
}

}  // namespace experiments

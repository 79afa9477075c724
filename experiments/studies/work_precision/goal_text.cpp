// The texts of the two goals on the page work_precision.md.
#include "experiments/studies/work_precision/data_profile.hpp"
#include "experiments/studies/work_precision/goal.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace experiments {
namespace {

std::vector<std::string> bodies_of(const std::vector<const Diagram*>& poses)
{
    std::vector<std::string> bodies;
    for (const Diagram* pose : poses)
        if (std::ranges::find(bodies, pose->pose.body) == bodies.end()) bodies.push_back(pose->pose.body);
    return bodies;
}

// One row per group with a pose that counts, one column per body. cell: of a group and a body, with the number of poses that count.
template <typename Cell>
std::string table_by_body(const std::vector<std::string>& bodies, const std::vector<DeformerGroup>& groups, const Cell& cell)
{
    std::string header = "| group |", line = "|---|", rows;
    for (const std::string& body : bodies) header += " " + body + " |", line += "---|";
    for (const DeformerGroup& group : groups) {
        std::string cells;
        int reached = 0;
        for (const std::string& body : bodies) {
            const auto [text, solved] = cell(group, body);
            cells += " " + text + " |";
            reached += solved;
        }
        if (reached > 0) rows += fmt::format("| {} |{}\n", group.words, cells);
    }
    return rows.empty() ? "No deformer reaches it in any pose.\n\n" : header + "\n" + line + "\n" + rows + "\n";
}

std::string solved_table(const std::vector<Diagram>& diagrams, const std::vector<std::string>& bodies, Comparison comparison)
{
    const auto cell = [&](const DeformerGroup& group, const std::string& body) {
        const Solved solved = solved_within(diagrams, comparison, group, goal_pct, goal_ms, body, true);
        return std::pair(text_of(solved), solved.solved);
    };
    return fmt::format(
               "The diagram's goal is an error of at most {:g} % within {:g} ms. The table counts the poses that reach it, including "
               "training poses. A pose is certain if the error plus the bound on the reference's own error is at most {:g} %:\n\n",
               goal_pct, goal_ms, goal_pct) +
           table_by_body(bodies, groups_of(diagrams), cell);
}

std::string solver_count_table(const std::vector<Diagram>& diagrams, const std::vector<std::string>& bodies, Comparison comparison)
{
    const auto cell = [&](const DeformerGroup& group, const std::string& body) {
        const SolverSolved count = solver_goal_reached(diagrams, comparison, group, body);
        const std::string unknown = count.unknown ? fmt::format(" (Newton's time is not known in {})", count.unknown) : "";
        return std::pair(fmt::format("{} of {}, {} in time{}", count.solved, count.poses, count.in_time, unknown), count.in_time);
    };
    return fmt::format(
               "The solver's goal is a distance of at most {:g} % from the own limit within {:g} ms, and within a thirtieth of the time "
               "that Newton's method takes to the same distance. The own limit is linear elements with the law of the deformers that "
               "minimise an energy, on the case's own tets. A cell has the number of poses that reach the goal. `in time` counts those "
               "that come within the distance in {:g} ms, regardless of Newton's time. Training poses are included. The bound on the "
               "reference's own error has no part in it:\n\n",
               solver_goal_pct, solver_goal_ms, solver_goal_ms) +
           table_by_body(bodies, groups_of(diagrams), cell);
}

std::string cell_of(const std::optional<double>& value, const char* format = "{:.2g}")
{
    return value ? fmt::format(fmt::runtime(format), *value) : "";
}

std::string cells_of(const Diagram& diagram, GoalPoint which, const std::string& none)
{
    const std::optional<GoalRow> row = goal_row(diagram, which);
    if (!row) return fmt::format(" {} | | |", none);
    return fmt::format(" {} | {:.2g} | {:.1f} |", text_of(row->point.key), row->point.ms, row->point.error_pct);
}

std::string case_cell(const Diagram& diagram)
{
    return diagram.key + (diagram.half == Half::training ? " (training)" : "");
}

std::string error_table(const std::vector<const Diagram*>& poses)
{
    std::string text = fmt::format(
        "Linear elements have the reference's law, on the case's own tets. Where their error is above {0:g} %, the last columns have the "
        "fastest point on a finer mesh that is within {0:g} %, or else the nearest one there.\n\n"
        "| case | bound [%] | linear elements [%] | nearest within {1:g} ms | ms | error [%] | fastest within {0:g} % | ms | error [%] | "
        "on a finer mesh | ms | error [%] |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n",
        goal_pct, goal_ms);
    for (const Diagram* pose : poses) {
        const DiagramPoint* linear = linear_elements_of(*pose);
        const std::string no_finer = !linear ? "not known" : linear->error_pct > goal_pct ? "no finer mesh" : "not needed";
        text +=
            fmt::format("| {} | {} | {} |{}{}{}\n", case_cell(*pose), cell_of(pose->reference_error_pct),
                        linear ? fmt::format("{:.1f}", linear->error_pct) : "", cells_of(*pose, GoalPoint::nearest_within_time, "none"),
                        cells_of(*pose, GoalPoint::fastest_within_error, "none"), cells_of(*pose, GoalPoint::best_on_finer_mesh, no_finer));
    }
    return text + "\n";
}

std::string solver_table(const std::vector<const Diagram*>& poses)
{
    std::string rows;
    for (const Diagram* pose : poses) {
        const std::optional<GoalRow> row = goal_row(*pose, GoalPoint::fastest_to_linear_elements);
        if (!row) continue;
        const std::string start = row->newton_start ? analysis::recorded_name(*row->newton_start) : "";
        const std::string ratio = row->newton_goal_ms ? fmt::format("{:.0f}", *row->newton_goal_ms / row->point.ms) : "";
        rows += fmt::format("| {} | {} | {} | {:.2g} | {} | {} | {} | {} | {} | {} |\n", case_cell(*pose),
                            cell_of(row->own_limit_pct, "{:.1f}"), text_of(row->point.key), row->point.ms,
                            cell_of(row->point.to_linear_elements_pct), cell_of(row->newton_goal_ms, "{:.0f}"), start, ratio,
                            row->reaches_goal ? "yes" : "no", cell_of(row->newton_warm_ms, "{:.0f}"));
    }
    if (rows.empty()) return "";
    return fmt::format(
               "The fastest deformer that is within {:g} % of the own limit; finite elements do not count. Newton's method is timed from "
               "its fastest cold start to the same distance, and for comparison from the solution of the frame before.\n\n"
               "| case | error of the own limit [%] | deformer | ms | distance [%] | Newton's method [ms] | its start | ratio | "
               "goal reached | from the frame before [ms] |\n|---|---|---|---|---|---|---|---|---|---|\n",
               solver_goal_pct) +
           rows + "\n";
}

}  // namespace

std::string goal_text(const std::vector<Diagram>& diagrams, Comparison comparison)
{
    std::vector<const Diagram*> poses;
    for (const Diagram& diagram : diagrams)
        if (diagram.comparison == comparison && is_pose(diagram)) poses.push_back(&diagram);
    const std::vector<std::string> bodies = bodies_of(poses);
    return solved_table(diagrams, bodies, comparison) + error_table(poses) + solver_count_table(diagrams, bodies, comparison) +
           solver_table(poses);
}

}  // namespace experiments

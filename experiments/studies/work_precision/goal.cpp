#include "experiments/studies/work_precision/goal.hpp"

#include <algorithm>
#include <tuple>

namespace experiments {
namespace {

using analysis::Columns;
using analysis::within;

const DiagramPoint* linear_elements_with(const Diagram& diagram, const std::string& law)
{
    const auto found = std::ranges::find_if(diagram.points, [&](const DiagramPoint& point) {
        const SettingKey& key = point.key;
        return key.deformer == law && key.element_order == 1 && !key.refined && !key.wanted_vertices;
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

// On a finer mesh, where the reference's linear elements on the case's own tets are above the goal. Finite elements do not count.
const DiagramPoint* best_on_finer_mesh(const Diagram& diagram)
{
    const DiagramPoint* linear = linear_elements_of(diagram);
    if (!linear || linear->error_pct <= goal_pct) return nullptr;
    const auto is_finer = [&](const DiagramPoint& point) {
        return !point.key.element_order && (point.key.refined || point.key.wanted_vertices.value_or(0) > diagram.vertices);
    };
    const auto within_goal = [&](const DiagramPoint& point) { return is_finer(point) && point.error_pct <= goal_pct; };
    const DiagramPoint* fastest = least(diagram, within_goal, [](const DiagramPoint& one) { return one.ms; });
    return fastest ? fastest : least(diagram, is_finer, [](const DiagramPoint& one) { return std::tuple(one.error_pct, one.ms); });
}

// Finite elements do not count: the limit itself is one of them.
bool is_near_its_limit(const DiagramPoint& point)
{
    return !point.key.element_order && point.to_linear_elements_pct && *point.to_linear_elements_pct <= solver_goal_pct;
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
        case GoalPoint::best_on_finer_mesh:
            return best_on_finer_mesh(diagram);
        case GoalPoint::fastest_to_linear_elements:
            break;
    }
    return least(diagram, is_near_its_limit, by_time);
}

bool is_in_time(const DiagramPoint& point)
{
    return is_near_its_limit(point) && point.ms <= solver_goal_ms;
}

bool reaches_solver_goal(const Diagram& diagram, const DiagramPoint& point)
{
    return is_in_time(point) && diagram.newton && solver_goal_speed_up * point.ms <= *diagram.newton->ms_median;
}

const Columns<DiagramPoint> distance_columns = {
    {"to_linear_elements_joint_pct", &DiagramPoint::to_linear_elements_pct, "%",
     "distance at the joints from linear elements with the law of the deformers that minimise an energy, on the case's own tets"}};

}  // namespace

const Columns<GoalRow> goal_columns =
    Columns<GoalRow>{
        {"comparison", &GoalRow::comparison, "", "packed_f32 or plain_f64"},
        {"case", &GoalRow::diagram, "", "name of the case's run"},
        {"half", &GoalRow::half, "", "training or evaluation"},
        {"linear_elements_joint_pct", &GoalRow::linear_elements_pct, "%",
         "error of the reference's law with linear elements on the case's own tets"},
        {"own_limit_joint_pct", &GoalRow::own_limit_pct, "%",
         "error of linear elements on these tets with the law of the deformers that minimise an energy, which is their own limit"},
        {"newton_converged_ms", &GoalRow::newton_converged_ms, "ms",
         "time per frame of Newton's method for the own limit, from the solution of the frame before until it converges"},
        {"newton_goal_ms", &GoalRow::newton_goal_ms, "ms",
         "time of Newton's method from its fastest cold start to within 1 % of the own limit"},
        {"newton_start", &GoalRow::newton_start, "", "that start: smooth_dqs, lbs or rest"},
        {"newton_warm_ms", &GoalRow::newton_warm_ms, "ms", "the same from the solution of the frame before, which no goal depends on"},
        {"point", &GoalRow::which, "",
         "nearest_within_time (3 ms), fastest_within_error (5 %), best_on_finer_mesh (the fastest one within 5 %, else the nearest one) or "
         "fastest_to_linear_elements (1 %)"}} +
    within(&GoalRow::point, diagram_point_columns() + Columns<DiagramPoint>{measures().front()}) +
    within(&GoalRow::point, distance_columns) +
    Columns<GoalRow>{
        {"reference_error_joint_pct", &GoalRow::reference_error_pct, "%", "bound of the reference's own error at the joints"},
        {"reaches_goal", &GoalRow::reaches_goal, "",
         "at most 5 % within 3 ms; of fastest_to_linear_elements: within 6 ms and a thirtieth of newton_goal_ms"},
        {"is_certain", &GoalRow::is_certain, "",
         "the goal is reached, and the error plus the reference's bound is at most 5 %; fastest_to_linear_elements has no such bound"}};

const DiagramPoint* linear_elements_of(const Diagram& diagram)
{
    return linear_elements_with(diagram, "fem_neo_hookean");
}

const DiagramPoint* own_limit_of(const Diagram& diagram)
{
    return linear_elements_with(diagram, "fem_stable_neo_hookean");
}

std::optional<GoalRow> goal_row(const Diagram& diagram, GoalPoint which)
{
    const DiagramPoint *point = goal_point(diagram, which), *linear = linear_elements_of(diagram), *limit = own_limit_of(diagram);
    if (!point) return std::nullopt;
    GoalRow row{.comparison = diagram.comparison, .diagram = diagram.key, .half = diagram.half, .which = which, .point = *point};
    if (linear) row.linear_elements_pct = linear->error_pct;
    if (limit) row.own_limit_pct = limit->error_pct, row.newton_converged_ms = limit->ms;
    if (diagram.newton) row.newton_goal_ms = diagram.newton->ms_median, row.newton_start = diagram.newton->start;
    row.newton_warm_ms = diagram.newton_warm_ms;
    row.reference_error_pct = diagram.reference_error_pct;
    if (which == GoalPoint::fastest_to_linear_elements) {
        row.reaches_goal = row.is_certain = reaches_solver_goal(diagram, *point);
        return row;
    }
    row.reaches_goal = point->ms <= goal_ms && point->error_pct <= goal_pct;
    row.is_certain = row.reaches_goal && diagram.reference_error_pct && point->error_pct + *diagram.reference_error_pct <= goal_pct;
    return row;
}

std::vector<GoalRow> goal_rows(const std::vector<Diagram>& diagrams)
{
    std::vector<GoalRow> rows;
    for (const Diagram& diagram : diagrams)
        for (const auto& [which, name] : analysis::EnumNames<GoalPoint>::table)
            if (const auto row = is_pose(diagram) ? goal_row(diagram, which) : std::nullopt) rows.push_back(*row);
    return rows;
}

SolverSolved solver_goal_reached(const std::vector<Diagram>& diagrams, Comparison comparison, const DeformerGroup& group,
                                 const std::string& body)
{
    SolverSolved count;
    for (const Diagram& diagram : diagrams) {
        if (diagram.comparison != comparison || !is_pose(diagram) || diagram.pose.body != body) continue;
        ++count.poses;
        if (!diagram.newton) ++count.unknown;
        std::vector<std::size_t> indices;
        diagram.of(group.deformers, indices);
        count.solved += std::ranges::any_of(indices, [&](std::size_t i) { return reaches_solver_goal(diagram, diagram.points[i]); });
        count.in_time += std::ranges::any_of(indices, [&](std::size_t i) { return is_in_time(diagram.points[i]); });
    }
    return count;
}

}  // namespace experiments

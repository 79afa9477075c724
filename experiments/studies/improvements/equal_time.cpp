#include "experiments/studies/improvements/equal_time.hpp"

#include "experiments/studies/shared/posed_character.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>

namespace experiments {
namespace {

using analysis::CaseKey;
using analysis::Columns;
using analysis::within;

using Curve = std::vector<ChangePoint>;                          // one setting in one pose, by iterations
using CurveKey = std::tuple<CaseKey, std::string, std::string>;  // pose, change, setting

std::map<CurveKey, Curve> curves_of(const std::vector<ChangePoint>& points)
{
    std::map<CurveKey, Curve> curves;
    for (const ChangePoint& point : points) curves[{point.of, point.change, point.setting}].push_back(point);
    for (auto& [key, curve] : curves) std::ranges::sort(curve, {}, &ChangePoint::iterations);
    return curves;
}

// The error of a setting at a budget. The result is empty if the setting takes longer or is not finite at this budget.
std::optional<EqualTimeRow> value_at(const Curve& curve, int budget_iterations, double budget_ms)
{
    const auto slower = std::ranges::find_if(curve, [&](const ChangePoint& point) { return point.ms.median > budget_ms; });
    if (slower == curve.begin()) return std::nullopt;
    const ChangePoint &before = *(slower - 1), &after = slower == curve.end() ? before : *slower;
    if (!before.error_joint_pct || !after.error_joint_pct) return std::nullopt;
    const double share =
        after.ms.median > before.ms.median ? std::log(budget_ms / before.ms.median) / std::log(after.ms.median / before.ms.median) : 0.0;
    EqualTimeRow row;
    row.of = before.of;
    row.budget_iterations = budget_iterations;
    row.budget_ms = budget_ms;
    row.change = before.change;
    row.setting = before.setting;
    row.iterations = std::lerp(double(before.iterations), double(after.iterations), share);
    row.error_pct = std::lerp(*before.error_joint_pct, *after.error_joint_pct, share);
    const auto one = before.distance_from_baseline(budget_iterations), other = after.distance_from_baseline(budget_iterations);
    if (one && other) row.distance_pct = std::max(*one, *other);
    row.reference_error_pct = before.reference_error_joint_pct;
    row.volume_change_pct = before.metrics.volume_change_pct;
    return row;
}

using Reached = std::map<CaseKey, std::map<std::string, EqualTimeRow>>;  // of one change at one budget: by pose and setting

// The setting with the least mean error over the other poses where the change has values. One that lacks a value there is not chosen, if
// there is another one. With one pose alone it is the first setting.
std::string chosen_setting(const Reached& reached, const CaseKey& pose)
{
    std::string best;
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [setting, own] : reached.at(pose)) {
        double sum = 0.0;
        for (const auto& [other, rows] : reached)
            if (other != pose) sum += rows.contains(setting) ? rows.at(setting).error_pct : std::numeric_limits<double>::infinity();
        if (best.empty() || sum < least) best = setting, least = sum;
    }
    return best;
}

}  // namespace

const Columns<EqualTimeRow> equal_time_columns =
    Columns<EqualTimeRow>{{"group", &EqualTimeRow::group, "", "the poses on which settings are chosen: all, or those of a body"}} +
    within(&EqualTimeRow::of, pose_columns()) +
    Columns<EqualTimeRow>{
        {"budget_iterations", &EqualTimeRow::budget_iterations, "", "iterations of the baseline whose time is the budget"},
        {"budget_ms", &EqualTimeRow::budget_ms, "ms", "that time"},
        {"change", &EqualTimeRow::change, "", "name of the change"},
        {"setting", &EqualTimeRow::setting, "", "of its parameter, chosen on the other poses"},
        {"iterations", &EqualTimeRow::iterations, "", "of the change that fit into the budget, interpolated"},
        {"baseline_error_pct", &EqualTimeRow::baseline_error_pct, "%", "error of the baseline at the joints"},
        {"error_pct", &EqualTimeRow::error_pct, "%", "error of the change at the joints"},
        {"from_pbs_pct", &EqualTimeRow::distance_pct, "%", "distance of the two shapes at the joints"},
        {"reference_error_pct", &EqualTimeRow::reference_error_pct, "%", "bound on the reference's own error at the joints"},
        {"volume_change_pct", &EqualTimeRow::volume_change_pct, "%", "signed change of the volume of the change's shape"}};

namespace {

// The poses of a group: their curves but the baseline's, and the baseline after each budget's iterations.
std::vector<EqualTimeRow> rows_of_group(const std::string& group, const std::map<CurveKey, Curve>& curves,
                                        const std::vector<ChangePoint>& points)
{
    std::vector<EqualTimeRow> rows;
    for (const int budget : budget_iterations) {
        std::map<CaseKey, ChangePoint> of_baseline;
        for (const ChangePoint& point : points)
            if (point.change == baseline && point.iterations == budget && point.error_joint_pct) of_baseline.emplace(point.of, point);
        std::map<std::string, Reached> reached;  // by change
        for (const auto& [key, curve] : curves) {
            const auto& [pose, change, setting] = key;
            if (change == baseline || !of_baseline.contains(pose) || (group != all_poses && pose.body != group)) continue;
            const ChangePoint& base = of_baseline.at(pose);
            auto row = value_at(curve, budget, base.ms.median);
            if (!row) continue;
            row->group = group;
            row->baseline_error_pct = *base.error_joint_pct;
            reached[change][pose].emplace(setting, *row);
        }
        for (const auto& [change, of_change] : reached)
            for (const auto& [pose, settings] : of_change) rows.push_back(settings.at(chosen_setting(of_change, pose)));
    }
    return rows;
}

}  // namespace

std::vector<EqualTimeRow> at_equal_time(const std::vector<ChangePoint>& points)
{
    std::vector<std::string> groups = {all_poses};
    std::set<std::string> bodies;
    for (const ChangePoint& point : points) bodies.insert(point.of.body);
    if (bodies.size() > 1) groups.insert(groups.end(), bodies.begin(), bodies.end());
    const std::map<CurveKey, Curve> curves = curves_of(points);
    std::vector<EqualTimeRow> rows;
    for (const std::string& group : groups)
        for (EqualTimeRow& row : rows_of_group(group, curves, points)) rows.push_back(std::move(row));
    return rows;
}

}  // namespace experiments

#include "experiments/studies/work_precision/gains.hpp"

#include "analysis/statistics/statistics.hpp"
#include "analysis/verdicts/pair_order.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <tuple>

namespace experiments {
namespace {

using analysis::CaseKey;
using analysis::Columns;

using Curve = std::vector<PointRow>;                             // one setting in one pose, by iterations
using CurveKey = std::tuple<CaseKey, std::string, std::string>;  // pose, change, setting

constexpr double not_known = std::numeric_limits<double>::infinity();
constexpr int fewest_poses = 4;

// A row without a time is one whose frames are not finite: it takes longer than any budget.
double ms_of(const PointRow& point)
{
    return point.ms_median.value_or(not_known);
}

std::map<CurveKey, Curve> curves_of(const std::vector<PointRow>& points)
{
    std::map<CurveKey, Curve> curves;
    for (const PointRow& point : points) curves[{point.of, point.key.deformer, point.key.tuned}].push_back(point);
    for (auto& [key, curve] : curves) std::ranges::sort(curve, {}, [](const PointRow& point) { return point.key.iterations; });
    return curves;
}

// The error of a setting at a budget. The result is empty if the setting takes longer or is not finite at this budget.
std::optional<EqualTimeRow> value_at(const Curve& curve, int budget_iterations, double budget_ms)
{
    const auto slower = std::ranges::find_if(curve, [&](const PointRow& point) { return ms_of(point) > budget_ms; });
    if (slower == curve.begin()) return std::nullopt;
    const PointRow &before = *(slower - 1), &after = slower == curve.end() ? before : *slower;
    if (!before.error || !after.error) return std::nullopt;
    const double ms = ms_of(before), later_ms = ms_of(after);
    const double share = later_ms > ms ? std::log(budget_ms / ms) / std::log(later_ms / ms) : 0.0;
    EqualTimeRow row;
    row.of = before.of;
    row.budget_iterations = budget_iterations;
    row.change = before.key.deformer;
    row.setting = before.key.tuned;
    row.iterations = std::lerp(double(before.key.iterations.value()), double(after.key.iterations.value()), share);
    row.error_pct = std::lerp(before.error->joint_pct, after.error->joint_pct, share);
    const auto column = std::ranges::find(experiments::budget_iterations, budget_iterations) - experiments::budget_iterations.begin();
    const auto one = before.from_pbs_pct.at(column), other = after.from_pbs_pct.at(column);
    if (one && other) row.from_pbs_pct = std::max(*one, *other);
    row.reference_error_pct = before.reference_error_joint_pct;
    row.volume_change_pct = before.metrics ? before.metrics->volume_change_pct : 0.0;
    return row;
}

using Reached = std::map<CaseKey, std::map<std::string, EqualTimeRow>>;  // of one change at one budget: by pose and setting

// The setting with the least mean error over the other poses where the change has values. One that lacks a value there is not chosen, if
// there is another one. With one pose alone it is the first setting.
std::string chosen_setting(const Reached& reached, const CaseKey& pose)
{
    std::string best;
    double least = not_known;
    for (const auto& [setting, own] : reached.at(pose)) {
        double sum = 0.0;
        for (const auto& [other, rows] : reached)
            if (other != pose) sum += rows.contains(setting) ? rows.at(setting).error_pct : not_known;
        if (best.empty() || sum < least) best = setting, least = sum;
    }
    return best;
}

// The poses of a group: their curves but the baseline's, and the baseline after each budget's iterations.
std::vector<EqualTimeRow> rows_of_group(const std::string& group, const std::map<CurveKey, Curve>& curves,
                                        const std::vector<PointRow>& points)
{
    std::vector<EqualTimeRow> rows;
    for (const int budget : budget_iterations) {
        std::map<CaseKey, PointRow> of_baseline;
        for (const PointRow& point : points)
            if (point.key.deformer == baseline && point.key.iterations == budget && point.error && point.ms_median)
                of_baseline.emplace(point.of, point);
        std::map<std::string, Reached> reached;  // by change
        for (const auto& [key, curve] : curves) {
            const auto& [pose, change, setting] = key;
            if (change == baseline || !of_baseline.contains(pose) || (group != all_poses && pose.body != group)) continue;
            const PointRow& base = of_baseline.at(pose);
            auto row = value_at(curve, budget, *base.ms_median);
            if (!row) continue;
            row->group = group;
            row->baseline_error_pct = base.error->joint_pct;
            reached[change][pose].emplace(setting, *row);
        }
        for (const auto& [change, of_change] : reached)
            for (const auto& [pose, settings] : of_change) rows.push_back(settings.at(chosen_setting(of_change, pose)));
    }
    return rows;
}

// One pose of a comparison.
struct ComparedPose {
    double error = 0.0, than_error = 0.0;
    std::optional<double> shift = {};
};

GainRow gain_over(const std::vector<ComparedPose>& poses)
{
    GainRow row;
    std::vector<double> gains;
    double shift = 0.0;
    bool is_known = true;
    for (const ComparedPose& pose : poses) {
        gains.push_back(pose.than_error - pose.error);
        row.error_pct += pose.error / double(poses.size());
        row.than_error_pct += pose.than_error / double(poses.size());
        is_known = is_known && pose.shift;
        shift += pose.shift.value_or(0.0) / double(poses.size());
    }
    row.poses = static_cast<int>(poses.size());
    const analysis::Interval interval = analysis::bootstrap_mean(gains, {.block = 1});  // poses are no series
    row.gain_pct = interval.estimate;
    if (std::isfinite(interval.low)) row.gain_low_pct = interval.low, row.gain_high_pct = interval.high;
    if (is_known) row.reference_error_pct = shift;
    if (row.poses < fewest_poses)
        row.decision = GainDecision::few_poses;
    else if (!row.gain_low_pct || (*row.gain_low_pct <= 0.0 && *row.gain_high_pct >= 0.0))
        row.decision = GainDecision::poses_disagree;
    else
        row.decision = is_known && std::abs(row.gain_pct) > shift ? GainDecision::decided : GainDecision::reference_error;
    return row;
}

using ByPose = std::map<analysis::CaseKey, EqualTimeRow>;

GainRow over_baseline(const std::string& change, const ByPose& rows)
{
    std::vector<ComparedPose> poses;
    std::set<std::string> settings;
    double iterations = 0.0, volume = 0.0;
    for (const auto& [pose, row] : rows) {
        poses.push_back(
            {row.error_pct, row.baseline_error_pct,
             analysis::shift_of_difference({row.error_pct, row.baseline_error_pct, row.from_pbs_pct, row.reference_error_pct})});
        if (!row.setting.empty()) settings.insert(row.setting);
        iterations += row.iterations / double(rows.size());
        volume += std::abs(row.volume_change_pct) / double(rows.size());
    }
    GainRow gain = gain_over(poses);
    gain.change = change;
    gain.than = baseline;
    for (const std::string& setting : settings) gain.settings += (gain.settings.empty() ? "" : "+") + setting;
    gain.iterations = iterations;
    gain.volume_abs_pct = volume;
    return gain;
}

// Their distance is at most the sum of their distances from the baseline.
GainRow over_other(const std::string& change, const ByPose& rows, const std::string& than, const ByPose& others)
{
    std::vector<ComparedPose> poses;
    for (const auto& [pose, row] : rows) {
        if (!others.contains(pose)) continue;
        const EqualTimeRow& other = others.at(pose);
        std::optional<double> distance;
        if (row.from_pbs_pct && other.from_pbs_pct) distance = *row.from_pbs_pct + *other.from_pbs_pct;
        poses.push_back({row.error_pct, other.error_pct,
                         analysis::shift_of_difference({row.error_pct, other.error_pct, distance, row.reference_error_pct})});
    }
    GainRow gain = gain_over(poses);
    gain.change = change;
    gain.than = than;
    return gain;
}

// by change, at one budget
std::vector<GainRow> gains_at(const std::map<std::string, ByPose>& changes)
{
    std::vector<GainRow> gains;
    for (const auto& [change, by_pose] : changes) gains.push_back(over_baseline(change, by_pose));
    std::ranges::stable_sort(gains, std::greater(), &GainRow::gain_pct);
    const int most = gains.empty() ? 0 : std::ranges::max(gains, {}, &GainRow::poses).poses;
    std::vector<std::string> ranked;  // those with a value in every pose
    for (const GainRow& gain : gains)
        if (gain.change != control && gain.poses == most) ranked.push_back(gain.change);
    if (ranked.size() < 2) return gains;
    for (const std::string& than : {ranked[1], control})
        if (changes.contains(than)) gains.push_back(over_other(ranked[0], changes.at(ranked[0]), than, changes.at(than)));
    return gains;
}

using BodyAndChange = std::pair<std::string, std::string>;

std::map<BodyAndChange, std::string> usual_settings(const std::vector<EqualTimeRow>& rows)
{
    const bool has_bodies = std::ranges::any_of(rows, [](const EqualTimeRow& row) { return row.group != all_poses; });
    std::map<BodyAndChange, std::map<std::string, int>> times;
    std::map<BodyAndChange, std::string> usual;
    for (const EqualTimeRow& row : rows) {
        usual[{row.of.body, baseline}] = "";
        if (row.budget_iterations == 96 && (row.group == all_poses) != has_bodies) ++times[{row.of.body, row.change}][row.setting];
    }
    for (const auto& [key, settings] : times)
        usual[key] = std::ranges::max_element(settings, {}, [](const auto& setting) { return setting.second; })->first;
    return usual;
}

}  // namespace

std::vector<EqualTimeRow> at_equal_time(const std::vector<PointRow>& points)
{
    std::vector<std::string> groups = {all_poses};
    std::set<std::string> bodies;
    for (const PointRow& point : points) bodies.insert(point.of.body);
    if (bodies.size() > 1) groups.insert(groups.end(), bodies.begin(), bodies.end());
    const std::map<CurveKey, Curve> curves = curves_of(points);
    std::vector<EqualTimeRow> rows;
    for (const std::string& group : groups)
        for (EqualTimeRow& row : rows_of_group(group, curves, points)) rows.push_back(std::move(row));
    return rows;
}

const analysis::Columns<GainRow> gain_columns =
    MEMBER_COLUMNS(GainRow, group, budget_iterations, change, than, poses, error_pct, than_error_pct, gain_pct, gain_low_pct, gain_high_pct,
                   reference_error_pct, decision, settings, iterations, volume_abs_pct);

std::vector<GainRow> gains_of(const std::vector<EqualTimeRow>& rows)
{
    std::vector<std::string> groups;
    for (const EqualTimeRow& row : rows)
        if (std::ranges::find(groups, row.group) == groups.end()) groups.push_back(row.group);
    std::vector<GainRow> all;
    for (const std::string& group : groups)
        for (const int budget : budget_iterations) {
            std::map<std::string, ByPose> changes;
            for (const EqualTimeRow& row : rows)
                if (row.group == group && row.budget_iterations == budget) changes[row.change].emplace(row.of, row);
            for (GainRow& gain : gains_at(changes)) {
                gain.group = group;
                gain.budget_iterations = budget;
                all.push_back(std::move(gain));
            }
        }
    return all;
}

const Columns<CurveRow> curve_columns = MEMBER_COLUMNS(CurveRow, body, change, setting, iterations, poses) +
                                        Columns<CurveRow>{{"mean_ms", &CurveRow::ms}, {"error_joint_pct", &CurveRow::error_pct}};

std::vector<CurveRow> mean_curves(const std::vector<PointRow>& points, const std::vector<EqualTimeRow>& rows)
{
    std::vector<CurveRow> curves;
    const std::map<BodyAndChange, std::string> usual = usual_settings(rows);
    for (const PointRow& point : points) {
        const SettingKey& key = point.key;
        const auto setting = usual.find({point.of.body, key.deformer});
        if (setting == usual.end() || setting->second != key.tuned || !point.error || !point.ms_median) continue;
        auto curve = std::ranges::find_if(curves, [&](const CurveRow& row) {
            return row.body == point.of.body && row.change == key.deformer && row.iterations == key.iterations;
        });
        if (curve == curves.end()) {
            curves.push_back({point.of.body, key.deformer, key.tuned, key.iterations.value()});
            curve = curves.end() - 1;
        }
        ++curve->poses;
        curve->ms += (*point.ms_median - curve->ms) / curve->poses;
        curve->error_pct += (point.error->joint_pct - curve->error_pct) / curve->poses;
    }
    return curves;
}

}  // namespace experiments

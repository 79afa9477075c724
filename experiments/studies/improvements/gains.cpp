#include "experiments/studies/improvements/gains.hpp"

#include "analysis/statistics/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>

namespace experiments {

std::optional<double> shift_of_difference(double one_error, double other_error, double distance, std::optional<double> bound)
{
    if (!bound || !std::isfinite(*bound)) return std::nullopt;
    const double least_sum = one_error + other_error - 2.0 * *bound;  // of the distances to any point within the bound of the reference
    const double slope = least_sum > 0.0 ? std::min(2.0, 2.0 * distance / least_sum) : 2.0;
    return slope * *bound;
}

namespace {

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
        poses.push_back({row.error_pct, row.baseline_error_pct,
                         shift_of_difference(row.error_pct, row.baseline_error_pct,
                                             row.distance_pct.value_or(std::numeric_limits<double>::infinity()), row.reference_error_pct)});
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
        constexpr double unknown = std::numeric_limits<double>::infinity();
        const double distance = row.distance_pct.value_or(unknown) + other.distance_pct.value_or(unknown);
        poses.push_back(
            {row.error_pct, other.error_pct, shift_of_difference(row.error_pct, other.error_pct, distance, row.reference_error_pct)});
    }
    GainRow gain = gain_over(poses);
    gain.change = change;
    gain.than = than;
    return gain;
}

}  // namespace

const analysis::Columns<GainRow> gain_columns = {
    {"group", &GainRow::group, "", "the poses: all, or those of a body"},
    {"budget_iterations", &GainRow::budget_iterations, "", "iterations of the baseline whose time is the budget"},
    {"change", &GainRow::change, "", "name of the change"},
    {"than", &GainRow::than, "", "what it is compared with: pbs, the baseline, or another change"},
    {"poses", &GainRow::poses, "", "number of poses"},
    {"error_pct", &GainRow::error_pct, "%", "mean error of the change at the joints"},
    {"than_error_pct", &GainRow::than_error_pct, "%", "mean error of what it is compared with"},
    {"gain_pct", &GainRow::gain_pct, "%", "mean of the difference of the two errors, in percentage points"},
    {"gain_low_pct", &GainRow::gain_low_pct, "%", "lower end of its 95 % interval over the poses (bootstrap)"},
    {"gain_high_pct", &GainRow::gain_high_pct, "%", "upper end"},
    {"reference_error_pct", &GainRow::reference_error_pct, "%", "by which the reference's own error may change the mean"},
    {"decision", &GainRow::decision, "",
     "decided, few_poses (fewer than four), poses_disagree (the interval includes zero), reference_error"},
    {"settings", &GainRow::settings, "", "settings that were chosen on the other poses, joined by +"},
    {"iterations", &GainRow::iterations, "", "mean number of iterations within the budget"},
    {"volume_abs_pct", &GainRow::volume_abs_pct, "%", "mean of the absolute change of the volume"}};

namespace {

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

}  // namespace

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

}  // namespace experiments

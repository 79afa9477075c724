// The gain of each change over the baseline in equal time, in the mean over the poses of a group, and whether it is decided.
//   const std::vector<GainRow> gains = gains_of(at_equal_time(points));
// The reference's own error U can reverse the order of two shapes A and B. It changes the difference of their errors by at most U times the
// largest distance between the two unit vectors that point from A and from B to the reference. This distance is at most 2, and at most
// 2 |A - B| / (e_A + e_B) (C. Dunkl, K. Williams, A simple norm inequality, American Mathematical Monthly 71, 1964). The errors e_A and e_B
// are at least the measured ones less U.
#pragma once

#include "experiments/studies/improvements/measured_changes.hpp"

#include <optional>
#include <string>
#include <vector>

namespace experiments {

// The gain of each change to PBS in the same time as the baseline.
//   const std::vector<EqualTimeRow> rows = at_equal_time(points);
// Budget: the baseline's time after 4, 24 or 96 iterations in the same pose. The error of a setting at that time is interpolated between
// its iterations, linearly in the logarithm of the time. Beyond the largest number of iterations the error is constant; below the smallest
// number there is none.
// Poses are compared in groups: all of them, and those of each body where there are several. A change's setting in a pose is the one with
// the least mean error at the same budget over the other poses of the group, so that no setting is evaluated on a pose on which it was
// chosen.
inline const std::string all_poses = "all";  // the group of all poses

// One change in one pose at one budget.
struct EqualTimeRow {
    std::string group;  // all, or a body
    analysis::CaseKey of;
    int budget_iterations = 0;
    double budget_ms = 0.0;
    std::string change, setting;
    double iterations = 0.0;  // that fit into the budget, interpolated
    double baseline_error_pct = 0.0, error_pct = 0.0;
    std::optional<double> distance_pct = {};         // from the baseline: the larger one of the points that are interpolated
    std::optional<double> reference_error_pct = {};  // bound on the reference's own error
    double volume_change_pct = 0.0;                  // at the nearest number of iterations within the budget

    double gain_pct() const { return baseline_error_pct - error_pct; }  // percentage points
};
extern const analysis::Columns<EqualTimeRow> equal_time_columns;

// points: of all poses, in which at least one setting of every change is finite. A change without a value at the budget has no row.
std::vector<EqualTimeRow> at_equal_time(const std::vector<ChangePoint>& points);

// By how much the reference's own error may change the difference between the errors of two shapes (above). Nothing where the bound is not
// known.
std::optional<double> shift_of_difference(double one_error, double other_error, double distance, std::optional<double> bound);

inline constexpr int fewest_poses = 4;  // with fewer ones the interval of the bootstrap is not reliable

enum class GainDecision {
    decided,          // the interval over the poses excludes zero, and the reference's own error cannot reverse the mean
    few_poses,        // fewer than fewest_poses
    poses_disagree,   // the interval over the poses includes zero
    reference_error,  // the mean is within the reference's own error, or that is not known
};

// The mean over the poses of the difference between two errors: that of `than` less that of `change`.
struct GainRow {
    std::string group;  // all, or a body
    int budget_iterations = 0;
    std::string change, than;  // than: the baseline, or another change
    int poses = 0;
    double error_pct = 0.0, than_error_pct = 0.0;  // means
    double gain_pct = 0.0;                         // the mean of than_error - error
    std::optional<double> gain_low_pct = {}, gain_high_pct = {};
    std::optional<double> reference_error_pct = {};  // by which the reference's own error may change the mean
    GainDecision decision = GainDecision::few_poses;
    std::string settings;                           // that were chosen, each once, joined by +
    double iterations = 0.0, volume_abs_pct = 0.0;  // means: iterations within the budget, |volume change|
};
extern const analysis::Columns<GainRow> gain_columns;

// Per group and budget: each change relative to the baseline, the largest gain first; then the first change relative to the second one and
// to the control. The control (change_settings.hpp) is no change, and a change without a value in some pose has no such mean: they are not
// compared with the others.
std::vector<GainRow> gains_of(const std::vector<EqualTimeRow>& rows);

}  // namespace experiments

template <>
struct analysis::EnumNames<experiments::GainDecision> {
    static constexpr std::array<std::pair<experiments::GainDecision, const char*>, 4> table{
        {{experiments::GainDecision::decided, "decided"},
         {experiments::GainDecision::few_poses, "few_poses"},
         {experiments::GainDecision::poses_disagree, "poses_disagree"},
         {experiments::GainDecision::reference_error, "reference_error"}}};
};

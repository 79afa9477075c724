// What each change to PBS gains when it may take the time that the baseline takes.
//   const std::vector<EqualTimeRow> rows = at_equal_time(points);
//   const std::vector<GainRow> gains = gains_of(rows);
// Budget: the baseline's time after 4, 24 or 96 iterations in the same pose. The error of a setting at that time is interpolated between
// its iterations, linearly in the logarithm of the time; after its last iterations it stays, and before its first it has none.
// Poses are compared in groups: all of them, and those of each body where there are several. A change's setting in a pose is the one with
// the least mean error at the same budget over the other poses of the group, so that no pose judges a setting that was chosen on it.
// Whether the order of two shapes A and B could be reversed by the reference's own error U: the difference of their errors changes at most
// by U times the largest distance of the two unit vectors from A and from B to the reference, which is at most 2 |A - B| / (e_A + e_B) (C.
// Dunkl, K. Williams, A simple norm inequality, American Mathematical Monthly 71, 1964), and at most 2.
#pragma once

#include "analysis/bootstrap.hpp"
#include "experiments/studies/improvements/measured_changes.hpp"

#include <optional>
#include <string>
#include <vector>

namespace experiments {

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

inline const std::string all_poses = "all";
inline constexpr int fewest_poses = 4;  // with fewer ones the bootstrap knows next to nothing about other poses

enum class GainDecision {
    decided,          // the interval over the poses excludes zero, and the reference's own error cannot reverse the mean
    few_poses,        // the interval over the poses includes zero, or there are fewer poses than fewest_poses
    reference_error,  // the mean is within the reference's own error, or that is not known
};

// The mean over the poses of the difference between two errors. one: of the first, less: of what is subtracted; by pose.
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
    std::string settings;                           // that were chosen, each once
    double iterations = 0.0, volume_abs_pct = 0.0;  // means: iterations within the budget, |volume change|
};
extern const analysis::Columns<GainRow> gain_columns;

// Per group and budget: each change relative to the baseline, the largest gain first; then the first change relative to the second one and
// to the control. The control
// (change_settings.hpp) is no change, and a change without a value in some pose has no such mean: they are not compared with the others.
std::vector<GainRow> gains_of(const std::vector<EqualTimeRow>& rows);

}  // namespace experiments

template <>
struct analysis::EnumNames<experiments::GainDecision> {
    static constexpr std::array<std::pair<experiments::GainDecision, const char*>, 3> table{
        {{experiments::GainDecision::decided, "decided"},
         {experiments::GainDecision::few_poses, "few_poses"},
         {experiments::GainDecision::reference_error, "reference_error"}}};
};

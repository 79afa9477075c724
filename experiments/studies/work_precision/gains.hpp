// The gain of each change to PBS over PBS in equal time, in the mean over the poses of a group, and whether it is decided.
//   const std::vector<EqualTimeRow> rows = at_equal_time(changes);   // the rows of changes.csv of all poses
//   const std::vector<GainRow> gains = gains_of(rows);
// Budget: the baseline's time after 4, 24 or 96 iterations in the same pose. The error of a setting at that time is interpolated between
// its iterations, linearly in the logarithm of the time. Beyond the largest number of iterations the error is constant; below the smallest
// number there is none. Poses are compared in groups: all of them, and those of each body where there are several. A change's setting in a
// pose is the one with the least mean error at the same budget over the other poses of the group, so that no setting is evaluated on a pose
// on which it was chosen. How much the reference's own error may change a gain: analysis/verdicts/pair_order.hpp.
#pragma once

#include "experiments/studies/work_precision/measured_points.hpp"

#include <optional>
#include <string>
#include <vector>

namespace experiments {

inline const std::string all_poses = "all";  // the group of all poses

// One change in one pose at one budget.
struct EqualTimeRow {
    std::string group;  // all, or a body
    analysis::CaseKey of;
    int budget_iterations = 0;
    std::string change, setting;
    double iterations = 0.0;  // that fit into the budget, interpolated
    double baseline_error_pct = 0.0, error_pct = 0.0;
    std::optional<double> from_pbs_pct = {};         // from the baseline: the larger one of the points that are interpolated
    std::optional<double> reference_error_pct = {};  // bound on the reference's own error
    double volume_change_pct = 0.0;                  // at the nearest number of iterations within the budget

    double gain_pct() const { return baseline_error_pct - error_pct; }  // percentage points
};

// points: of all poses, in which at least one setting of every change is finite. A change without a value at the budget has no row.
std::vector<EqualTimeRow> at_equal_time(const std::vector<PointRow>& points);

enum class GainDecision {
    decided,          // the interval over the poses excludes zero, and the reference's own error cannot reverse the mean
    few_poses,        // fewer than four, with which the interval of the bootstrap is not reliable
    poses_disagree,   // the interval over the poses includes zero
    reference_error,  // the mean is within the reference's own error, or that is not known
};

template <>
inline constexpr NameTable<GainDecision, 4> option_names<GainDecision>{{{GainDecision::decided, "decided"},
                                                                        {GainDecision::few_poses, "few_poses"},
                                                                        {GainDecision::poses_disagree, "poses_disagree"},
                                                                        {GainDecision::reference_error, "reference_error"}}};

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
// to the control. The control (compared_deformers.hpp) is no change, and a change without a value in some pose has no such mean: they are
// not compared with the others.
std::vector<GainRow> gains_of(const std::vector<EqualTimeRow>& rows);

// A point of a curve in the figure: the mean over the poses of a body at one number of iterations. The setting is the one that was chosen
// for most of these poses at the budget of 96 iterations.
struct CurveRow {
    std::string body, change, setting;
    int iterations = 0, poses = 0;
    double ms = 0.0, error_pct = 0.0;
};
extern const analysis::Columns<CurveRow> curve_columns;
std::vector<CurveRow> mean_curves(const std::vector<PointRow>& points, const std::vector<EqualTimeRow>& rows);

}  // namespace experiments

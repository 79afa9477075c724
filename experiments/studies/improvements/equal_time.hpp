// The gain of each change to PBS in the same time as the baseline.
//   const std::vector<EqualTimeRow> rows = at_equal_time(points);
// Budget: the baseline's time after 4, 24 or 96 iterations in the same pose. The error of a setting at that time is interpolated between
// its iterations, linearly in the logarithm of the time. Beyond the largest number of iterations the error is constant; below the smallest
// number there is none.
// Poses are compared in groups: all of them, and those of each body where there are several. A change's setting in a pose is the one with
// the least mean error at the same budget over the other poses of the group, so that no setting is evaluated on a pose on which it was
// chosen.
#pragma once

#include "experiments/studies/improvements/measured_changes.hpp"

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

}  // namespace experiments

// Work-precision diagrams from the recorded points. There is one per pose. There is also one of the mean over the poses of a body, if these
// are three or more (the limb is one body, twisted or bent); it shows what a setting is worth that is not chosen anew for each pose.
// Likewise there is one of the mean over the bodies in a pose, if these are three or more.
//   for (const Diagram& diagram : diagrams_of({points_of_a, points_of_b})) ...
// The recorded error of a point is error_joint_pct: the root mean square over the blended vertices, over their mean distance to the bone.
#pragma once

#include "analysis/pareto_front.hpp"
#include "experiments/studies/work_precision/point_row.hpp"

#include <optional>
#include <string>
#include <vector>

namespace experiments {

struct DiagramPoint {
    SettingKey key;
    double ms = 0.0;
    std::optional<double> ms_q1 = {}, ms_q3 = {};  // nothing where there were too few rounds
    double error_pct = 0.0;
    std::optional<double> l2_pct = {}, linf_m = {}, volume_abs_change_pct = {};
    bool below_reference_error = false;
};

// The measures of fronts, named as the points' columns: error_joint_pct, which all sentences use, error_l2_pct, error_linf_m and
// volume_abs_change_pct.
const analysis::Columns<DiagramPoint>& measures();
double value_of(const DiagramPoint& point, const std::string& measure);  // not a number where it is not recorded

struct Diagram {
    analysis::CaseKey pose;                     // of one case; a mean of several has none
    std::string key;                            // limb_twist_90, or limb_mean_of_4_poses
    std::string name;                           // for readers: limb, twist, 90 deg
    std::vector<DiagramPoint> points;           // those with a time and an error; the reference has no error
    std::string reference;                      // its name for readers; empty: none was reached
    std::optional<double> reference_ms;         // wall time of its solutions
    std::optional<double> reference_error_pct;  // bound at the joints
    double masked_share_pct = 0.0;              // of the volume, which overlaps itself and is left out
    int poses = 1;

    // The points of these deformers with their cost and measure. indices[k] is the place of the k-th in `points`.
    std::vector<analysis::WorkPrecision> of(const std::vector<std::string>& deformers, std::vector<std::size_t>& indices,
                                            const std::string& measure = "error_joint_pct") const;
};

// The times and errors of a mean are means over the poses. It has those settings that have an error in each pose.
std::vector<Diagram> diagrams_of(const std::vector<std::vector<PointRow>>& points);

// The points of PBS with 1, 4, 24 and 96 iterations and defaults otherwise. Their times are the budgets of the other deformers.
std::vector<DiagramPoint> budgets_of(const Diagram& diagram);

// Deformers that are one entry in sentences and tables.
struct DeformerGroup {
    std::string key, words;  // linear_fem, linear FEM
    std::vector<std::string> deformers;
};
const std::vector<DeformerGroup>& deformer_groups();
const DeformerGroup& group_of(const std::string& deformer);
const DeformerGroup& group_named(const std::string& key);

// The best of the group's points within a budget of time. Null where none is as fast.
const DiagramPoint* best_of(const Diagram& diagram, const DeformerGroup& group, double budget_ms);

}  // namespace experiments

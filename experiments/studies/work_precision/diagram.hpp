// Work-precision diagrams from the recorded points: one per comparison and pose, with the settings that were chosen on the training poses.
// There is also one of the mean over the evaluated poses of a body, if these are three or more (the limb is one body, twisted or bent), one
// of the mean over the bodies in a pose, if these are three or more, and one of the mean over all evaluated poses.
//   for (const Diagram& diagram : diagrams_of(cases, choose_settings(rows_of(cases)))) ...
// The recorded error of a point is error_joint_pct: the root mean square over the blended vertices, over their mean distance to the bone.
#pragma once

#include "analysis/statistics/minimise.hpp"
#include "experiments/studies/work_precision/chosen_settings.hpp"
#include "experiments/studies/work_precision/deformer_groups.hpp"

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
    MemberErrors members = {};  // against the further references
};

// The measures of fronts, named as the points' columns: error_joint_pct, which all sentences use, error_l2_pct, error_linf_m and
// volume_abs_change_pct.
const analysis::Columns<DiagramPoint>& measures();
double value_of(const DiagramPoint& point, const std::string& measure);  // not a number where it is not recorded
const analysis::Columns<DiagramPoint>& diagram_point_columns();          // deformer, its setting, ms_median

// A further reference in a diagram.
struct DiagramMember {
    bool takes_part = false;
    std::optional<double> bound_pct = {};
};

struct Diagram {
    Comparison comparison = Comparison::packed_f32;
    Half half = Half::evaluation;
    analysis::CaseKey pose;                     // of one case; a mean of several has none
    std::string key;                            // limb_twist_90, or limb_mean_of_4_poses
    std::string name;                           // for readers: limb, twist, 90 deg
    std::vector<DiagramPoint> points;           // those with a time and an error; the reference has no error
    std::string reference;                      // its name for readers; empty: none was reached
    std::optional<double> reference_ms;         // wall time of its solutions
    std::optional<double> reference_error_pct;  // bound at the joints
    std::array<DiagramMember, further_members> members = {};
    double masked_share_pct = 0.0;  // of the volume, which overlaps itself and is left out
    int poses = 1;
    std::vector<std::string> cases = {};                    // of a mean: the keys of its poses
    std::vector<DeformerGroup> groups = deformer_groups();  // those of the user's own deformers last

    // The points of these deformers with their cost and measure. indices[k] is the place of the k-th in `points`.
    std::vector<analysis::WorkPrecision> of(const std::vector<std::string>& deformers, std::vector<std::size_t>& indices,
                                            const std::string& measure = "error_joint_pct") const;
};

// The groups of all diagrams of a record, which are the same.
const std::vector<DeformerGroup>& groups_of(const std::vector<Diagram>& diagrams);

bool is_pose(const Diagram& diagram);  // with a reference; a mean over several poses is none

struct CaseRecords {
    CaseRows rows;
    std::vector<FamilyRow> members = {};
};

// Returns a diagram for each case, training cases included, and one for each mean over evaluated poses. The times and errors of a mean are
// means over its poses. A mean has only those settings that have an error in each of its poses.
std::vector<Diagram> diagrams_of(const std::vector<CaseRecords>& cases, const std::vector<ChosenSetting>& chosen);

// The best of the group's points within a budget of time. Null where none is as fast.
const DiagramPoint* best_of(const Diagram& diagram, const DeformerGroup& group, double budget_ms);

}  // namespace experiments

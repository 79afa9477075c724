// Work-precision diagrams from the points on record: one a pose, and of three poses or more of a body (both of the limb's motions are one
// body's) one of their mean: what a setting is worth that is not chosen anew for each pose. So of a pose that three bodies or more take;
// bodies with many poses and bodies with one are never thrown together.
//   for (const Diagram& diagram : diagrams_of({points_of_a, points_of_b})) ...
// On record as a point's error: error_joint_pct, the root mean square over the blended vertices, over their mean distance to the bone.
#pragma once

#include "analysis/pareto_front.hpp"
#include "experiments/studies/work_precision/point_row.hpp"

#include <optional>
#include <string>
#include <vector>

namespace experiments {

struct DiagramPoint {
    std::string deformer, setting;
    double ms = 0.0;
    std::optional<double> ms_q1 = {}, ms_q3 = {};  // nothing where there were too few rounds
    double error_pct = 0.0;
    std::optional<double> l2_pct = {}, linf_m = {}, volume_abs_change_pct = {};
    std::optional<double> beside_pct = {};  // against the second solution beside the reference
    bool below_reference_error = false;

    std::string words() const { return setting.empty() ? deformer : deformer + ", " + setting; }
};

// What a front may be of, by the points' columns: error_joint_pct, which all sentences speak of, error_l2_pct, error_linf_m and
// volume_abs_change_pct.
const std::vector<std::string>& measures();
double value_of(const DiagramPoint& point, const std::string& measure);  // not a number where it is not on record

struct Diagram {
    std::string body, pose;            // "limb twist", "90 deg"
    std::string name;                  // "limb twist, 90 deg"
    std::vector<DiagramPoint> points;  // that have a time and an error; the reference has none
    std::string reference;             // its deformer's name; empty: none was reached
    std::optional<double> reference_ms;
    std::optional<double> reference_error_pct;
    std::optional<double> reference_difference_pct;  // of the second solution from it
    int poses = 1;
    int self_intersecting = 0;  // poses whose reference intersects itself

    // The points of these deformers, by cost and measure; indices[k] is the k-th's place in `points`.
    std::vector<analysis::WorkPrecision> of(const std::vector<std::string>& deformers, std::vector<std::size_t>& indices,
                                            const std::string& measure = measures().front()) const;
};

// Of the mean: times and errors are means over the poses, of the settings that have an error in each pose with a reference.
std::vector<Diagram> diagrams_of(const std::vector<std::vector<PointRow>>& points);

// The points of PBS with 1, 4, 24 and 96 iterations, all else by default: budgets of time that others are held to.
std::vector<DiagramPoint> budgets_of(const Diagram& diagram);

// Deformers that are spoken of together.
struct DeformerGroup {
    std::string words;
    std::vector<std::string> deformers;
};
const std::vector<DeformerGroup>& deformer_groups();
const DeformerGroup& group_of(const std::string& deformer);

// The group's points of a diagram: the best within a budget; null where none is so cheap.
const DiagramPoint* best_of(const Diagram& diagram, const DeformerGroup& group, double budget_ms);

}  // namespace experiments

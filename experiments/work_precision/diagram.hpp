// Work-precision diagrams from the points on record: one a pose, and of three poses or more of a body, and of all bodies, one of their
// mean: what a setting is worth that is not chosen anew for each pose.
//   for (const Diagram& diagram : diagrams_of({read_csv("a/points.csv"), read_csv("b/points.csv")})) ...
// On record as a point's error: error_joint_pct, the root mean square over the blended vertices, over their mean distance to the bone.
#pragma once

#include "analysis/csv_table.hpp"
#include "analysis/pareto_front.hpp"

#include <optional>
#include <string>
#include <vector>

namespace experiments {

struct DiagramPoint {
    std::string deformer, setting;
    double ms = 0.0, ms_q1 = 0.0, ms_q3 = 0.0;
    double error_pct = 0.0;
    std::optional<double> beside_pct = {};  // against the second solution beside the reference
    bool below_reference_error = false;

    std::string words() const { return setting.empty() ? deformer : deformer + ", " + setting; }
};

struct Diagram {
    std::string name;                  // "limb twist, 90 deg"
    std::vector<DiagramPoint> points;  // that have a time and an error; the reference has none
    std::string reference;             // its deformer's name; empty: none was reached
    std::optional<double> reference_ms;
    std::optional<double> reference_error_pct;
    std::optional<double> reference_difference_pct;  // of the second solution from it

    // The points of these deformers, by cost and error; indices[k] is the k-th's place in `points`.
    std::vector<analysis::WorkPrecision> of(const std::vector<std::string>& deformers, std::vector<std::size_t>& indices) const;
};

// Of the mean: times and errors are means over the poses, of the settings that have an error in each pose with a reference.
std::vector<Diagram> diagrams_of(const std::vector<analysis::CsvTable>& points);

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

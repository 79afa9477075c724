// For each group of deformers the evaluated pose, the comparison and the budget of time at which it is nearest to the reference. A deformer
// that is nearest nowhere is dominated in these poses.
//   for (const Win& win : wins_of(diagrams)) ...
#pragma once

#include "experiments/studies/work_precision/diagram_tables.hpp"

namespace experiments {

// The best of the places where the group has rank 1: a decided one before others, then the one with the largest lead.
struct Win {
    std::string group;
    std::optional<BudgetRow> nearest = {};  // nothing: it is nearest nowhere
    std::optional<std::string> next = {};   // the group of rank 2; nothing: the group is the only one
    std::optional<double> next_error_pct = {};
    int places = 0;  // evaluated poses, comparisons and budgets where it has rank 1
};

// In the order of the groups. Groups without a point in any evaluated pose are left out, and so are means over poses.
std::vector<Win> wins_of(const std::vector<Diagram>& diagrams);

std::string wins_text(const std::vector<Diagram>& diagrams);  // Markdown

}  // namespace experiments

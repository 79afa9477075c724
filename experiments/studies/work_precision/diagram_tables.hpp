// What follows from work-precision diagrams, as tables: fronts, who is nearer than whom from which time on, who is how near at equal cost.
#pragma once

#include "experiments/studies/work_precision/diagram.hpp"

namespace experiments {

// The Pareto front of all points of each diagram (front "all") and of each deformer's own, by each measure: `value` is the measure's.
// The reference is no candidate.
analysis::CsvTable fronts_table(const std::vector<Diagram>& diagrams);

// Each group of deformers against each other one: the time a frame [ms] from which on its best is nearer to the reference, with the
// quartiles of the point that does it; outcome always, from, never. From there on, at every time at which both are there: told_apart, the
// two errors differ by more than twice the reference's own; holds_beside, it is nearer to the second solution too (certainty.hpp).
analysis::CsvTable crossings_table(const std::vector<Diagram>& diagrams);

// The best of each group within the time of PBS with 1, 4, 24 and 96 iterations at the scene's k_stretch.
analysis::CsvTable equal_cost_table(const std::vector<Diagram>& diagrams);

}  // namespace experiments

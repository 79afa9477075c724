// The results of work-precision diagrams as tables: the fronts, which group of deformers is nearer from which time on, and how near
// each group is at equal cost.
#pragma once

#include "experiments/studies/work_precision/diagram.hpp"

namespace experiments {

// fronts.csv: the Pareto front of all points of each diagram (front "all") and of each deformer's own points, by each measure. `value` is
// that of the measure. The reference is not a candidate.
analysis::CsvTable fronts_table(const std::vector<Diagram>& diagrams);

// crossings.csv: for each group of deformers and each other one, the time per frame [ms] from which on its best point is nearer to the
// reference, with the quartiles of the point at which this happens. The outcome is always, from or never. The last column,
// decided, holds for all times from there on at which both have points: the two errors differ by more than twice the bound of the
// reference's own error (certainty.hpp).
analysis::CsvTable crossings_table(const std::vector<Diagram>& diagrams);

// equal_cost.csv: the best point of each group within the time of PBS with 1, 4, 24 and 96 iterations at the scene's k_stretch.
struct BudgetRow {
    std::string diagram;
    std::optional<int> budget_iterations;
    double budget_ms = 0.0;
    std::string group;
    DiagramPoint point;
};
extern const analysis::Columns<BudgetRow> budget_columns;
std::vector<BudgetRow> equal_cost(const std::vector<Diagram>& diagrams);

}  // namespace experiments

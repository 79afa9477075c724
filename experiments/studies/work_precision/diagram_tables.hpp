// The results of work-precision diagrams as tables: the fronts, which group of deformers is nearer from which time on, and the best point
// of each group within a time. Every order is marked as decided or with the reason why not (certainty.hpp).
#pragma once

#include "experiments/studies/work_precision/certainty.hpp"

namespace experiments {

// fronts.csv: the Pareto front of all points of each diagram (front "all") and of each deformer's own points, by each measure. `value` is
// that of the measure. The reference is not a candidate. On the front of all by error_joint_pct, `decision` states whether the point is
// nearer than the best point of any other group within its time. The other fronts have no decision: the references bound no other measure
// in each point, and a front of one deformer compares its settings with each other.
analysis::CsvTable fronts_table(const std::vector<Diagram>& diagrams);

// crossings.csv: for each group of deformers and each other one, the time per frame [ms] from which on its best point is nearer to the
// reference, with the quartiles of the point at which this happens. The outcome is always, from or never. `decision` is the worst one at
// all times from there on at which both have points.
analysis::CsvTable crossings_table(const std::vector<Diagram>& diagrams);

inline constexpr int ranks_of_a_pose = 3;
inline constexpr std::array<double, 5> budgets_ms = {0.1, 1.0, 3.0, 10.0, 100.0};

// best_within.csv: the best point of each group within a budget, the nearest group first. `decision` is whether it is nearer than every
// group of a later rank within the budget: undecided if one of these is undecided. Figure, fronts and sentences use this rule.
struct BudgetRow {
    Comparison comparison = Comparison::packed_f32;
    std::string diagram;
    double budget_ms = 0.0;
    int rank = 0;  // from 1
    std::string group;
    DiagramPoint point;
    std::optional<analysis::PairDecision> decision = {};  // nothing: there is no group of a later rank
    std::vector<std::string> undecided_against = {};      // keys of these groups
    std::string reason = {};                              // of the worst decision
};
extern const analysis::Columns<BudgetRow> budget_columns;

// Whether a ranked row is nearer than each later one: the worst decision.
struct RankDecision {
    Decision worst;
    std::vector<std::string> undecided = {};  // keys of the groups against which it is undecided

    std::string remark(const Diagram& diagram) const;  // follows a sentence and names these groups; empty where it is decided
};
// Nothing where there is no later row.
std::optional<RankDecision> rank_decision(const Diagram& diagram, const std::vector<BudgetRow>& ranked, std::size_t place);
std::vector<BudgetRow> best_within(const Diagram& diagram, double budget_ms);
std::vector<BudgetRow> best_within(const std::vector<Diagram>& diagrams);  // all budgets; of a single pose the first ranks alone

}  // namespace experiments

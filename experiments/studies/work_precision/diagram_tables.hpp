// The results of work-precision diagrams as tables: the fronts, which group of deformers is nearer from which time on, and the best point
// of each group within a time. Every order is marked as decided or with the reason why not (diagram.hpp).
#pragma once

#include "experiments/studies/work_precision/diagram.hpp"

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
// group of a later rank within the budget: undecided if one of these is undecided. Figure and fronts use this rule.
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

std::vector<BudgetRow> best_within(const Diagram& diagram, double budget_ms);
std::vector<BudgetRow> best_within(const std::vector<Diagram>& diagrams);  // all budgets; of a single pose the first ranks alone

// Data profiles (J. More, S. Wild, Benchmarking derivative-free optimization algorithms, SIAM J. Optim. 20, 2009): the share of poses that
// a deformer solves to a tolerance, against the time per frame. A pose is solved to 5 % within t if a point of the deformer takes at most t
// and has an error of at most 5 % at the joints.
//   const std::vector<ProfileStep> steps = data_profiles(diagrams);   // one step per time at which a share rises
inline constexpr std::array<double, 3> profile_tolerances_pct = {10.0, 5.0, 2.0};

struct ProfileStep {
    Comparison comparison = Comparison::packed_f32;
    double tolerance_pct = 0.0;
    std::string group;  // of deformers
    double ms = 0.0;    // from this time per frame on
    int solved = 0, poses = 0;
    int certain = 0;  // of those solved: the error plus the bound on the reference's own error is within the tolerance
    double share_pct = 0.0;
};
extern const analysis::Columns<ProfileStep> data_profile_columns;  // data_profiles.csv

// Over the evaluated poses with a reference; a group that solves none has no steps. Means are no poses.
std::vector<ProfileStep> data_profiles(const std::vector<Diagram>& diagrams);

// Which deformer is missing where, and why. Every diagram shows the omissions of its case.
//   for (const Omission& omission : omissions_of(rows_of_all_cases)) ...

// The outcomes of points without an answer; no_such_code: the deformer has no code of this comparison; not_run: it has no point in this
// case although it has in others; no_reference: there is no error, since the reference was not reached. Its reason has the worst tet of the
// reference's last state.
struct Omission {
    Comparison comparison = Comparison::packed_f32;
    std::string of = {};  // the case, or the mean over several
    std::string deformer = {};
    std::string why = {};         // not_finite, not_converged, over_time_limit, not_applicable, no_such_code, not_run, no_reference
    int missing = 0, points = 0;  // points that are missing for this reason, of all that the deformer has in the case or mean
    std::string reason = {};      // of the first of them, for readers
};
extern const analysis::Columns<Omission> omission_columns;  // omissions.csv

std::vector<Omission> omissions_of(const std::vector<CaseRows>& cases);

// The omissions of the means among the diagrams: those of their poses added up, of the points in all poses of the mean.
std::vector<Omission> omissions_of_means(const std::vector<CaseRows>& cases, const std::vector<Diagram>& diagrams);

}  // namespace experiments

// Work-precision diagrams from the recorded points: one per comparison and pose, with the settings that were chosen on the training poses.
// There is also one of the mean over the evaluated poses of a body, if these are three or more (the limb is one body, twisted or bent), one
// of the mean over the bodies in a pose, if these are three or more, and one of the mean over all evaluated poses.
//   for (const Diagram& diagram : diagrams_of(cases, choose_settings(rows_of(cases)))) ...
// The recorded error of a point is error_joint_pct: the root mean square over the blended vertices, over their mean distance to the bone.
#pragma once

#include "analysis/statistics/minimise.hpp"
#include "analysis/verdicts/pair_order.hpp"
#include "experiments/studies/work_precision/compared_deformers.hpp"
#include "experiments/studies/work_precision/measured_points.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace experiments {

// The settings of each deformer: chosen on the training poses, shown on the others. There are two comparisons. packed_f32 has each deformer
// in the best code that it has: packed f32, plain f32, packed f64 or plain f64, in this order. plain_f64 has each deformer in plain f64
// code.
//   const std::vector<ChosenSetting> chosen = choose_settings(rows_of_all_cases);
// The settings that differ in the value of the grid alone are one choice: the one with the least geometric mean of error_joint_pct over the
// training poses that have them is chosen. Only settings that finished in all of these poses are candidates. A single setting is no choice
// and needs no training. Where no training pose has them, the default setting is chosen.
enum class Comparison { packed_f32, plain_f64 };
inline constexpr std::array<Comparison, 2> comparisons = {Comparison::packed_f32, Comparison::plain_f64};

template <>
inline constexpr NameTable<Comparison, 2> option_names<Comparison>{
    {{Comparison::packed_f32, "packed_f32"}, {Comparison::plain_f64, "plain_f64"}}};

using CaseRows = std::vector<PointRow>;  // of one case

// The best code of each deformer. In packed_f32 only that code takes part.
using BestCodes = std::map<std::string, int>;  // 3: packed f32, 2: plain f32, 1: packed f64, 0: plain f64
BestCodes best_codes(const std::vector<CaseRows>& cases);
// A deformer that has no entry in `best` takes part with any code.
bool takes_part(Comparison comparison, const SettingKey& key, const BestCodes& best);

struct ChosenSetting {
    Comparison comparison;
    SettingKey key;
    int tried = 0;           // settings of this choice
    int training_poses = 0;  // that decided; 0: there was no choice, or no training pose has its settings
    std::optional<double> training_error_joint_pct = {};
};
extern const analysis::Columns<ChosenSetting> chosen_columns;  // settings.csv

std::vector<ChosenSetting> choose_settings(const std::vector<CaseRows>& cases);

struct DiagramPoint {
    SettingKey key;
    double ms = 0.0;
    std::optional<double> ms_q1 = {}, ms_q3 = {};  // nothing where there were too few rounds
    double error_pct = 0.0;
    std::optional<double> l2_pct = {}, linf_m = {}, volume_abs_change_pct = {};
    bool below_reference_error = false;
    MemberErrors members = {};  // against the further references
};

// The measures of fronts, named as the points' columns: error_joint_pct, by which all orders are decided, error_l2_pct, error_linf_m and
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
    std::vector<DiagramPoint> points;           // those with a time and an error; the reference has no error
    bool has_reference = false;                 // one was reached
    std::optional<double> reference_error_pct;  // bound at the joints
    std::array<DiagramMember, further_members> members = {};
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

// Whether a statement "this point is nearer than that one" survives the choice of the reference and the references' own errors. Errors are
// distances: relative to the exact solution, each may be larger or smaller by the error of the reference. A reference orders two points if
// their errors differ by more than twice the bound of its own error (analysis/verdicts/pair_order.hpp with |A - B| <= e_A + e_B). A
// statement is decided if every reference of the ensemble orders the points in this way.
//   decision_on(diagram, pbs, delta_mush).reason
struct Decision {
    analysis::PairDecision decision = analysis::PairDecision::decided;
    std::string reason = {};  // why it is not decided; empty where it is
};

// `nearer` has the smaller error against the first reference.
Decision decision_on(const Diagram& diagram, const DiagramPoint& nearer, const DiagramPoint& other);

// The results of diagrams as tables: the fronts, which group of deformers is nearer from which time on, and the best point of each group
// within a time. Every order is marked as decided or with the reason why not.

// fronts.csv: the Pareto front of all points of each diagram (front "all") and of each deformer's own points, by each measure. `value` is
// that of the measure. The reference is not a candidate. On the front of all by error_joint_pct, `decision` states whether the point is
// nearer than the best point of any other group within its time. The other fronts have no decision: the references bound no other measure
// in each point, and a front of one deformer compares its settings with each other.
analysis::CsvTable fronts_table(const std::vector<Diagram>& diagrams);

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

// Work-precision diagrams from the recorded points: one per comparison and pose, with the settings that were chosen on the training poses.
// There is also one of the mean over all evaluated poses.
//   for (const Diagram& diagram : diagrams_of(cases, choose_settings(rows_of(cases)))) ...
// The recorded error of a point is error_joint_pct: the root mean square over the blended vertices, over their mean distance to the bone.
#pragma once

#include "analysis/statistics/statistics.hpp"
#include "analysis/verdicts/pair_order.hpp"
#include "experiments/studies/work_precision/compared_deformers.hpp"
#include "experiments/studies/work_precision/measured_points.hpp"

#include <map>
#include <memory>
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
std::vector<ChosenSetting> default_settings(const std::vector<CaseRows>& cases);  // the default one of each choice

struct DiagramPoint {
    SettingKey key;
    double ms = 0.0, error_pct = 0.0;
    MemberErrors members = {};  // against the further references
    std::size_t row = 0;        // of the case's points
};

const analysis::Columns<DiagramPoint>& diagram_point_columns();  // deformer, its setting, ms_median, error_joint_pct

// A further reference in a diagram.
struct DiagramMember {
    bool takes_part = false;
    std::optional<double> bound_pct = {};
};

struct Diagram {
    Comparison comparison = Comparison::packed_f32;
    Half half = Half::evaluation;
    analysis::CaseKey pose;                     // of one case; a mean of several has none
    std::string key;                            // limb_twist_90, or mean_of_9_evaluated_poses
    std::vector<DiagramPoint> points;           // those with a time and an error; the reference has no error
    bool has_reference = false;                 // one was reached
    std::optional<double> reference_error_pct;  // bound at the joints
    std::array<DiagramMember, further_members> members = {};
    int poses = 1;
    std::vector<Diagram> of_poses = {};                     // of a mean: these poses
    std::shared_ptr<const RecordedShapes> shapes = {};      // of one case; null: the distances of shapes are not known
    std::vector<DeformerGroup> groups = deformer_groups();  // those of the user's own deformers last

    // The points of these deformers with their cost and error. indices[k] is the place of the k-th in `points`.
    std::vector<analysis::WorkPrecision> of(const std::vector<std::string>& deformers, std::vector<std::size_t>& indices) const;
};

struct CaseRecords {
    CaseRows rows;
    std::vector<FamilyRow> members = {};
    std::shared_ptr<const RecordedShapes> shapes = {};
};

// Returns a diagram for each case, training cases included, and one for each mean over evaluated poses. The times and errors of a mean are
// means over its poses. A mean has only those settings that have an error in each of its poses.
std::vector<Diagram> diagrams_of(const std::vector<CaseRecords>& cases, const std::vector<ChosenSetting>& chosen);

// The best of the group's points within a budget of time. Null where none is as fast.
const DiagramPoint* best_of(const Diagram& diagram, const DeformerGroup& group, double budget_ms);

// How a reference orders two points, with the values that decide it (analysis/verdicts/pair_order.hpp). The sum of the errors stands for a
// distance that is not known. In a mean, the values are means over the poses, and the order is that of the mean difference.
struct ReferenceOrder {
    std::string member;  // of the family
    analysis::PairDistances distances;
    analysis::PairOrder order = analysis::PairOrder::undecided;
};
const analysis::Columns<ReferenceOrder>& reference_order_columns();
// One order for each reference that takes part, the first one first.
std::vector<ReferenceOrder> orders_on(const Diagram& diagram, const DiagramPoint& first, const DiagramPoint& second);

// Which class of deformers is nearest to the reference within a time per frame, and which deformer within that class.
//   const NearestAnswers answers = nearest_classes(diagrams_of(cases, choose_settings(rows)), diagrams_of(cases, default_settings(rows)));
// The nearest class is that of the best point within the time, with the settings that were chosen on the training poses. It is compared
// with the best point of each other class, in these settings and once more in the deformers' default settings. It is decided against
// another class if every reference orders the two in its favour in both. Otherwise the answer is "either of" the two. The deformers of the
// nearest class are compared in the same way.

struct NearestQuestion {
    Comparison comparison = Comparison::packed_f32;
    std::string diagram;
    double budget_ms = 0.0;
    std::string among = "classes";  // or the class whose deformers are compared
};

// How a reference orders the nearest one and another one. Both have a point within the time.
struct NearestPair {
    NearestQuestion of;
    std::string first, second;  // classes or deformers; the first is the nearest one
    std::string first_deformer, second_deformer;
    SettingsOf settings = SettingsOf::training_poses;
    ReferenceOrder by;
};
extern const analysis::Columns<NearestPair> nearest_pair_columns;  // nearest_pairs.csv

struct NearestAnswer {
    NearestQuestion of;
    std::string nearest;
    DiagramPoint point;                                   // of the nearest one, in the settings of the training poses
    int others = 0;                                       // classes or deformers that have a point within the time, too
    std::vector<std::string> either_of = {};              // those that the nearest one is not decided against
    std::optional<analysis::PairDecision> decision = {};  // the worst one against another; settings may disagree as models do
};
extern const analysis::Columns<NearestAnswer> nearest_columns;  // nearest.csv

struct NearestAnswers {
    std::vector<NearestAnswer> answers;
    std::vector<NearestPair> pairs;
};
// The answers for the evaluated poses and for their mean. A diagram of the default settings is paired with that of the same key.
NearestAnswers nearest_classes(const std::vector<Diagram>& chosen, const std::vector<Diagram>& defaults);

// fronts.csv: the Pareto front of all points of each diagram (front "all") and of each deformer's own points. The reference is not a
// candidate.
analysis::CsvTable fronts_table(const std::vector<Diagram>& diagrams);

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

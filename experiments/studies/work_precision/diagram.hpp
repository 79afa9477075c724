// Work-precision diagrams from the recorded points: one per comparison and pose, with the settings that were chosen on the training poses.
// There is also one of the mean over the evaluated poses of a body, if these are three or more (the limb is one body, twisted or bent), one
// of the mean over the bodies in a pose, if these are three or more, and one of the mean over all evaluated poses.
//   for (const Diagram& diagram : diagrams_of(cases, choose_settings(rows_of(cases)))) ...
// The recorded error of a point is error_joint_pct: the root mean square over the blended vertices, over their mean distance to the bone.
#pragma once

#include "analysis/statistics/minimise.hpp"
#include "analysis/verdicts/pair_order.hpp"
#include "experiments/studies/work_precision/compared_deformers.hpp"
#include "experiments/studies/work_precision/point_row.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace experiments {

// The setting of each rung: chosen on the training poses, shown on the others. There are two comparisons. packed_f32 has each deformer in
// the best code that it has: packed f32, plain f32, packed f64 or plain f64, in this order. plain_f64 has each deformer in plain f64 code.
//   const std::vector<ChosenSetting> chosen = choose_settings(rows_of_all_cases);
// The chosen setting of a rung has the least geometric mean of error_joint_pct over the training poses with that rung. Only settings
// that finished in all of these poses are candidates. A single setting is no choice and needs no training. Where no training pose has the
// rung, the default setting is chosen.
enum class Comparison { packed_f32, plain_f64 };
inline constexpr std::array<Comparison, 2> comparisons = {Comparison::packed_f32, Comparison::plain_f64};

using CaseRows = std::vector<PointRow>;  // of one case

// The best code of each deformer, by code_rank. In packed_f32 only that code takes part.
using BestCodes = std::map<std::string, int>;
int code_rank(const SettingKey& key);  // 3: packed f32, 2: plain f32, 1: packed f64, 0: plain f64
BestCodes best_codes(const std::vector<CaseRows>& cases);
// A deformer that has no entry in `best` takes part with any code.
bool takes_part(Comparison comparison, const SettingKey& key, const BestCodes& best);

struct ChosenSetting {
    Comparison comparison;
    SettingKey key;
    int tried = 0;           // settings of this rung
    int training_poses = 0;  // that decided; 0: there was no choice, or no training pose has the rung
    std::optional<double> training_error_pct = {};
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

// The worst decision at all times from `from_ms` on, for the best points of both groups. Nothing where one of the two has no points.
std::optional<Decision> decision_from(const Diagram& diagram, const DeformerGroup& one, const DeformerGroup& other, double from_ms);

}  // namespace experiments

template <>
struct analysis::EnumNames<experiments::Comparison> {
    static constexpr std::array<std::pair<experiments::Comparison, const char*>, 2> table{
        {{experiments::Comparison::packed_f32, "packed_f32"}, {experiments::Comparison::plain_f64, "plain_f64"}}};
};

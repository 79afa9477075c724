// points.csv: one row per setting, with its time, its work, its error, its volume and the reference that it is compared with. members.csv:
// the other references of the family. changes.csv: the rows of PBS and of single changes to it, with their distances from PBS.
#pragma once

#include "analysis/metrics/frame_metrics.hpp"
#include "analysis/records/tables.hpp"
#include "analysis/verdicts/case_record.hpp"
#include "experiments/settings/option_names.hpp"
#include "experiments/studies/shared/posed_reference.hpp"
#include "experiments/studies/work_precision/posed_deformer.hpp"
#include "pbs/geometry/cost.hpp"

#include <string>
#include <vector>

namespace experiments {

// Settings are chosen on the training poses, and the diagrams show the others.
enum class Half { training, evaluation };

template <>
inline constexpr NameTable<Half, 2> option_names<Half>{{{Half::training, "training"}, {Half::evaluation, "evaluation"}}};

inline constexpr std::array<int, 3> budget_iterations = {4, 24, 96};  // of PBS: a change is compared with it in the time of these

// The errors against the members of the family after the first one, in their order.
using MemberErrors = std::array<std::optional<double>, further_members>;

struct PointRow {
    analysis::CaseKey of = {};  // body, motion, and the pose or the angle
    SettingKey key;
    int vertices = 0, tets = 0;
    std::string outcome = {};
    double reach_ms = 0.0;
    int rounds = 0, failed_rounds = 0;
    std::optional<double> ms_median = {}, ms_q1 = {}, ms_q3 = {};
    std::optional<analysis::ErrorNorms> error = {};  // outside the part that overlaps; nothing where there is no reference
    std::optional<analysis::FrameMetrics> metrics = {};
    std::string reference = {};
    std::optional<double> reference_error_joint_pct = {}, reference_error_l2_pct = {};
    std::optional<double> reference_order = {};
    std::optional<bool> reference_order_is_reliable = {};
    std::optional<bool> below_reference_error = {};
    std::optional<double> error_whole_joint_pct = {}, masked_share_pct = {};
    // Of PBS at the joints: the distance from its own converged shape, the distance of that from the reference, the bound of the
    // reference's distance from its limit, and the distance of the converged shape from that after half of its iterations.
    std::optional<double> solver_pct = {}, model_pct = {}, discretisation_pct = {}, not_converged_pct = {};
    Half half = Half::evaluation;
    std::string reason = {};  // why the outcome is not_applicable or over_time_limit; why the reference is not reached
    std::optional<pbs::WorkCounters> work = {};
    std::optional<double> to_linear_elements_pct = {};  // of a point on the case's own tets
    MemberErrors members = {};
    bool is_external = false;              // a deformer of the user's own
    std::optional<FrameClock> clock = {};  // nothing where there is no time
    // Of PBS and of a change to it: the distances from PBS after each of budget_iterations, at the joints outside the overlap.
    std::array<std::optional<double>, budget_iterations.size()> from_pbs_pct = {};

    bool is_of_reference() const { return outcome == "reference" || outcome == "not_reached"; }
};
// All columns. The columns of the group "external" are written only if a deformer of the user's own takes part.
extern const analysis::Columns<PointRow> point_columns;
extern const analysis::Columns<PointRow> change_columns;  // changes.csv
analysis::Columns<PointRow> columns_for(const std::vector<PointRow>& rows);

// A further reference of the family, solved with quadratic elements on the case's own tets alone. Its bound is that of the first member's
// own solution on these tets, which is an assumption: the same elements have a similar error.
struct FamilyRow {
    analysis::CaseKey of;
    EnsembleMember member;
    std::string outcome;  // reached, not_reached
    std::optional<double> error_bound_pct = {};
    double masked_share_pct = 0.0;
    double solve_s = 0.0;
};
extern const analysis::Columns<FamilyRow> family_columns;

}  // namespace experiments

template <>
struct analysis::EnumNames<experiments::Half> : experiments::OptionNames<experiments::Half> {
};

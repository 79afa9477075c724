// points.csv: one row per setting, with its time, its work, its error, its volume and the reference that it is compared with. members.csv:
// the other references of the family.
#pragma once

#include "analysis/metrics/frame_metrics.hpp"
#include "analysis/records/tables.hpp"
#include "analysis/verdicts/case_record.hpp"
#include "experiments/studies/shared/posed_reference.hpp"
#include "experiments/studies/shared/timed_rounds.hpp"
#include "experiments/studies/work_precision/body_mesh.hpp"
#include "experiments/studies/work_precision/case_split.hpp"
#include "experiments/studies/work_precision/frame_clock.hpp"
#include "pbs/geometry/cost.hpp"

namespace experiments {

// The parts of PBS's error at the joints [%]. The third part is the error of the reference.
struct PbsParts {
    double solver_pct = 0.0, model_pct = 0.0;
    double not_converged_pct = 0.0;  // between the converged shape and that after half of its iterations
};

struct FrameTime {
    std::optional<Spread> ms;  // nothing where no round arrived
    int failed_rounds = 0;     // rounds that did not reach the pose, or began in one that was not reached
};
// samples: [ms], not a number where a round failed.
FrameTime frame_time(std::vector<double> samples);

constexpr int fewest_for_quartiles = 3;  // rounds

// The errors against the members of the family after the first one, in their order.
using MemberErrors = std::array<std::optional<double>, further_members>;

struct PointRow {
    analysis::CaseKey of = {};  // body, motion, and the pose or the angle
    SettingKey key;
    std::string setting = {};  // as a text
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
    std::optional<PbsParts> parts = {};
    std::optional<double> discretisation_pct = {};
    Half half = Half::evaluation;
    std::string reason = {};  // why the outcome is not_applicable or over_time_limit; why the reference is not reached
    std::optional<pbs::WorkCounters> work = {};
    std::optional<double> to_linear_elements_pct = {};  // of a point on the case's own tets
    MemberErrors members = {};
    bool is_external = false;              // a deformer of the user's own
    std::optional<FrameClock> clock = {};  // nothing where there is no time

    bool is_of_reference() const { return outcome == "reference" || outcome == "not_reached"; }
};
// All columns. The columns of the group "external" are written only if a deformer of the user's own takes part.
extern const analysis::Columns<PointRow> point_columns;
analysis::Columns<PointRow> columns_for(const std::vector<PointRow>& rows);

// A setting without an answer: outcome is over_time_limit or not_applicable.
PointRow row_without_answer(const PointSetting& setting, const BodyMesh& mesh, const std::string& outcome, const std::string& reason);
PointRow point_row(const ReachedPoint& point);
void add_time(PointRow& row, const FrameTime& time);
void add_reference(PointRow& row, const PosedReference& reference);  // and whether the error, if there is one, is below its bound
// The row of the reference itself. Its outcome is reference, or not_reached.
PointRow reference_row(const pbs::TetMesh& mesh, const PosedReference& reference);

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

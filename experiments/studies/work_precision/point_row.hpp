// points.csv: one row per setting, with its time, its error, its volume and the reference that it is compared with.
#pragma once

#include "analysis/case_key.hpp"
#include "analysis/frame_metrics.hpp"
#include "analysis/records/typed_table.hpp"
#include "experiments/studies/shared/timed_rounds.hpp"
#include "experiments/studies/shared/posed_reference.hpp"
#include "experiments/studies/work_precision/body_mesh.hpp"

namespace experiments {

// limb_twist_90, human_crouch: the name of a case's run, and of its diagram in the tables.
std::string case_name(const analysis::CaseKey& of);

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

struct PointValues {
    analysis::CaseKey of;
    FrameTime time = {};
    std::optional<analysis::ErrorNorms> error = {};  // outside the part that overlaps; nothing where there is no reference
    std::optional<double> whole_joint_pct = {};      // error at the joints, with the part where the body overlaps itself
    std::optional<PbsParts> parts = {};
};

struct PointRow {
    analysis::CaseKey of;  // body, motion, and the pose or the angle
    SettingKey key;
    std::string setting;  // as a text
    int vertices = 0, tets = 0;
    std::string outcome = {};
    double reach_ms = 0.0;
    int rounds = 0, failed_rounds = 0;
    std::optional<double> ms_median = {}, ms_q1 = {}, ms_q3 = {};
    std::optional<analysis::ErrorNorms> error = {};
    analysis::FrameMetrics metrics = {};
    std::string reference = {};
    std::optional<double> reference_error_joint_pct = {}, reference_error_l2_pct = {};
    std::optional<double> reference_order = {};
    std::optional<bool> reference_order_is_reliable = {};
    std::optional<bool> below_reference_error = {};
    std::optional<double> error_whole_joint_pct = {}, masked_share_pct = {};
    std::optional<PbsParts> parts = {};
    std::optional<double> discretisation_pct = {};
};
extern const analysis::Columns<PointRow> point_columns;

// reference: null where none is compared with.
PointRow point_row(const ReachedPoint& point, const PosedReference* reference, const PointValues& values);
// The row of the reference itself. Its outcome is reference, or not_reached.
PointRow reference_row(const analysis::CaseKey& of, const pbs::TetMesh& mesh, const PosedReference& reference);

}  // namespace experiments

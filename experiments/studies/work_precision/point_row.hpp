// points.csv: one row per setting, with its time, its error, its volume and the reference that it is compared with.
#pragma once

#include "analysis/case_key.hpp"
#include "analysis/frame_metrics.hpp"
#include "analysis/records/typed_table.hpp"
#include "experiments/studies/shared/timed_rounds.hpp"
#include "experiments/studies/work_precision/reached_reference.hpp"

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
    FrameTime time;
    std::optional<analysis::ErrorNorms> error;  // nothing for the reference, and where there is no reference
    std::optional<double> beside_pct;           // error at the joints against the second solution
    std::optional<PbsParts> parts;
    bool reference_self_intersects = false;
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
    std::string beside = {};
    std::optional<double> error_joint_beside_pct = {};
    std::optional<bool> below_reference_error = {}, reference_self_intersects = {};
    std::optional<PbsParts> parts = {};
    std::optional<double> discretisation_pct = {};
};
extern const analysis::Columns<PointRow> point_columns;

PointRow point_row(const ReachedPoint& point, const ReachedReference& reference, const PointValues& values);

}  // namespace experiments

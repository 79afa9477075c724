#include "experiments/studies/work_precision/point_row.hpp"

#include "pbs/geometry/topology.hpp"

#include <fmt/format.h>

#include <cmath>

namespace experiments {
namespace {

using analysis::CaseKey;
using analysis::Columns;
using analysis::ErrorNorms;
using analysis::FrameMetrics;
using analysis::within;

const Columns<CaseKey> case_columns = {{"body", &CaseKey::body, "", "name of the body"},
                                       {"motion", &CaseKey::motion, "", "twist, bend, or the name of a clip"},
                                       {"pose", &CaseKey::pose, "", "name of a pose in a clip"},
                                       {"angle_deg", &CaseKey::angle_deg, "deg", "angle of a joint that is twisted or bent"}};

const Columns<SettingKey> deformer_columns = {{"deformer", &SettingKey::deformer, "", "name of the deformer"}};

const Columns<ErrorNorms> error_columns = {
    {"error_joint_pct", &ErrorNorms::joint_pct, "%", "error over the blended vertices outside the overlap"},
    {"error_l2_pct", &ErrorNorms::l2_pct, "%", "error over all vertices outside the overlap"},
    {"error_linf_m", &ErrorNorms::linf_m, "m", "largest distance from the reference outside the overlap"}};

const Columns<FrameMetrics> volume_columns = {
    {"volume_change_pct", &FrameMetrics::volume_change_pct, "%", "signed change of the whole volume"},
    {"volume_abs_change_pct", &FrameMetrics::volume_abs_change_pct, "%", "sum of the absolute changes of each tet"},
    {"inverted", &FrameMetrics::inverted_tets, "", "number of inverted tets"}};

const Columns<PbsParts> before_discretisation = {
    {"solver_pct", &PbsParts::solver_pct, "%", "PBS: distance from its own converged shape, at the joints"},
    {"model_pct", &PbsParts::model_pct, "%", "PBS: distance of its converged shape from the reference, at the joints"}};
const Columns<PbsParts> after_discretisation = {{"not_converged_pct", &PbsParts::not_converged_pct, "%",
                                                 "PBS: distance of its converged shape from that after half of the iterations"}};

std::string outcome_of(const ReachedPoint& point)
{
    if (point.shape.finished) return "finished";
    return point.shape.positions.allFinite() ? "not_converged" : "not_finite";
}

void add_time(PointRow& row, const FrameTime& time)
{
    row.failed_rounds = time.failed_rounds;
    if (!time.ms) return;
    row.rounds = time.ms->rounds;
    row.ms_median = time.ms->median;
    if (time.ms->rounds >= fewest_for_quartiles) row.ms_q1 = time.ms->lower, row.ms_q3 = time.ms->upper;
}

void add_reference(PointRow& row, const PosedReference& reference)
{
    row.masked_share_pct = reference.masked_share_pct();
    if (!reference.is_reached()) return;
    row.reference = reference.label();
    if (!reference.order()) return;
    row.reference_error_joint_pct = reference.bound().joint_pct;
    row.reference_error_l2_pct = reference.bound().l2_pct;
    row.reference_order = reference.order()->observed;
    row.reference_order_is_reliable = reference.order()->reliable;
}

}  // namespace

using Points = Columns<PointRow>;
const Columns<PointRow> point_columns =
    within(&PointRow::of, case_columns) + within(&PointRow::key, deformer_columns) +
    Points{{"setting", &PointRow::setting, "",
            "the deformer and its setting as a text, which repeats the columns from iterations to refined"}} +
    within(&PointRow::key, setting_columns()) +
    Points{{"vertices", &PointRow::vertices, "", "vertices of the mesh that it is solved on"},
           {"tets", &PointRow::tets, "", "tets of that mesh"},
           {"outcome", &PointRow::outcome, "", "finished, not_converged or not_finite; reference, or not_reached"},
           {"reach_ms", &PointRow::reach_ms, "ms", "wall time from rest to the pose; of the reference: that of all its solutions"},
           {"rounds", &PointRow::rounds, "", "number of timed frames"},
           {"failed_rounds", &PointRow::failed_rounds, "", "frames that did not reach their pose and are left out"},
           {"ms_median", &PointRow::ms_median, "ms", "median of the processor time per frame"},
           {"ms_q1", &PointRow::ms_q1, "ms", "its lower quartile"},
           {"ms_q3", &PointRow::ms_q3, "ms", "its upper quartile"}} +
    within(&PointRow::error, error_columns) + within(&PointRow::metrics, volume_columns) +
    Points{{"reference", &PointRow::reference, "", "name of the reference; empty where none was reached"},
           {"reference_error_joint_pct", &PointRow::reference_error_joint_pct, "%", "bound of the reference's own error at the joints"},
           {"reference_error_l2_pct", &PointRow::reference_error_l2_pct, "%", "bound of the reference's own error over all vertices"},
           {"reference_order", &PointRow::reference_order, "", "order of convergence that is observed"},
           {"reference_order_is_reliable", &PointRow::reference_order_is_reliable, "",
            "that order is credible, and the bound has the safety factor 1.25 instead of 3"},
           {"below_reference_error", &PointRow::below_reference_error, "", "the error is not above the reference's own bound"},
           {"error_whole_joint_pct", &PointRow::error_whole_joint_pct, "%", "error over the blended vertices, those that overlap included"},
           {"masked_share_pct", &PointRow::masked_share_pct, "%",
            "share of the volume that the other errors leave out because the reference overlaps itself there"}} +
    within(&PointRow::parts, before_discretisation) +
    Points{{"discretisation_pct", &PointRow::discretisation_pct, "%", "PBS: bound of the reference's distance from its limit"}} +
    within(&PointRow::parts, after_discretisation);

std::string case_name(const CaseKey& of)
{
    return of.angle_deg ? fmt::format("{}_{}_{:g}", of.body, of.motion, *of.angle_deg) : of.body + "_" + of.pose;
}

FrameTime frame_time(std::vector<double> samples)
{
    FrameTime time;
    time.failed_rounds = static_cast<int>(std::erase_if(samples, [](double ms) { return std::isnan(ms); }));
    if (!samples.empty()) time.ms = spread_of(samples);
    return time;
}

PointRow point_row(const ReachedPoint& point, const PosedReference* reference, const PointValues& values)
{
    const pbs::TetMesh& mesh = point.mesh->character().mesh;
    PointRow row{values.of, key_of(*point.setting), text_of(key_of(*point.setting))};
    row.vertices = int(mesh.rest.rows());
    row.tets = int(mesh.tets.rows());
    row.outcome = outcome_of(point);
    row.reach_ms = 1e3 * point.shape.seconds;
    add_time(row, values.time);
    row.error = values.error;
    row.error_whole_joint_pct = values.whole_joint_pct;
    row.metrics = analysis::MeshMetrics(mesh.rest, mesh.tets).measure(point.shape.positions);
    row.parts = values.parts;
    if (reference) add_reference(row, *reference);
    if (values.error && row.reference_error_joint_pct)
        row.below_reference_error = values.error->joint_pct <= *row.reference_error_joint_pct;
    if (values.parts) row.discretisation_pct = row.reference_error_joint_pct;
    return row;
}

PointRow reference_row(const CaseKey& of, const pbs::TetMesh& mesh, const PosedReference& reference)
{
    const NestedSolution& solution = reference.is_reached() ? reference.reference() : reference.solutions().front();
    const SettingKey key{.deformer = "reference", .element_order = solution.element_order, .refined = solution.refinements > 0};
    PointRow row{of, key, text_of(key)};
    row.vertices = int(mesh.rest.rows() + (key.refined ? pbs::edges_of(mesh.tets).rows() : 0));
    row.tets = int(mesh.tets.rows()) * (key.refined ? 8 : 1);
    row.outcome = reference.is_reached() ? "reference" : "not_reached";
    for (const NestedSolution& one : reference.solutions()) row.reach_ms += 1e3 * one.seconds;
    row.metrics = analysis::MeshMetrics(mesh.rest, mesh.tets).measure(solution.positions);
    add_reference(row, reference);
    return row;
}

}  // namespace experiments

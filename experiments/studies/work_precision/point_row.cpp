#include "experiments/studies/work_precision/point_row.hpp"

#include "pbs/geometry/topology.hpp"

#include <cmath>

namespace experiments {
namespace {

std::string outcome_of(const ReachedPoint& point)
{
    if (point.shape.finished) return "finished";
    return point.shape.positions.allFinite() ? "not_converged" : "not_finite";
}

PointRow row_on(const PointSetting& setting, const BodyMesh& mesh)
{
    PointRow row{.key = key_of(setting)};
    row.setting = text_of(row.key);
    row.is_external = setting.is_external();
    row.vertices = int(mesh.character().mesh.rest.rows());
    row.tets = int(mesh.character().mesh.tets.rows());
    return row;
}

}  // namespace

FrameTime frame_time(std::vector<double> samples)
{
    FrameTime time;
    time.failed_rounds = static_cast<int>(std::erase_if(samples, [](double ms) { return std::isnan(ms); }));
    if (!samples.empty()) time.ms = spread_of(samples);
    return time;
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
    if (row.error) row.below_reference_error = row.error->joint_pct <= *row.reference_error_joint_pct;
    if (row.parts) row.discretisation_pct = row.reference_error_joint_pct;
}

PointRow row_without_answer(const PointSetting& setting, const BodyMesh& mesh, const std::string& outcome, const std::string& reason)
{
    PointRow row = row_on(setting, mesh);
    row.outcome = outcome;
    row.reason = reason;
    return row;
}

PointRow point_row(const ReachedPoint& point)
{
    PointRow row = row_on(*point.setting, *point.mesh);
    row.outcome = outcome_of(point);
    row.reach_ms = 1e3 * point.shape.seconds;
    const pbs::TetMesh& mesh = point.mesh->character().mesh;
    row.metrics = analysis::MeshMetrics(mesh.rest, mesh.tets).measure(point.shape.positions);
    return row;
}

PointRow reference_row(const pbs::TetMesh& mesh, const PosedReference& reference)
{
    const NestedSolution& solution = reference.is_reached() ? reference.reference() : reference.solutions().front();
    PointRow row{.key = {.deformer = "reference", .element_order = solution.element_order, .refined = solution.refinements > 0}};
    row.setting = text_of(row.key);
    row.vertices = int(mesh.rest.rows() + (row.key.refined ? pbs::edges_of(mesh.tets).rows() : 0));
    row.tets = int(mesh.tets.rows()) * (row.key.refined ? 8 : 1);
    row.outcome = reference.is_reached() ? "reference" : "not_reached";
    row.reason = reference.why_not_reached();
    for (const NestedSolution& one : reference.solutions()) row.reach_ms += 1e3 * one.seconds;
    row.metrics = analysis::MeshMetrics(mesh.rest, mesh.tets).measure(solution.positions);
    add_reference(row, reference);
    return row;
}

}  // namespace experiments

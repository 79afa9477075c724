#include "experiments/studies/work_precision/measured_points.hpp"

#include "experiments/process/machine.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "pbs/character/character.hpp"
#include "pbs/character/skinning_weights.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace experiments {
namespace {

std::shared_ptr<pbs::Character> character_with(pbs::CharacterSource source, int vertices)
{
    source.vertices = vertices;
    return std::make_shared<pbs::Character>(pbs::make_character(source));
}

using analysis::Columns;
using analysis::ErrorNorms;
using analysis::within;
using pbs::WorkCounters;

const Columns<ErrorNorms> error_columns = {
    {"error_joint_pct", &ErrorNorms::joint_pct, "%", "error over the blended vertices outside the overlap"},
    {"error_l2_pct", &ErrorNorms::l2_pct, "%", "error over all vertices outside the overlap"},
    {"error_linf_m", &ErrorNorms::linf_m, "m", "largest distance from the reference outside the overlap"}};

const Columns<WorkCounters> work_columns = {
    {"gradients", &WorkCounters::gradients, "", "gradients of an energy of the whole body, per frame"},
    {"vertex_visits", &WorkCounters::vertex_visits, "", "blends, smoothings, rotations and block solves of a vertex, per frame"},
    {"tet_visits", &WorkCounters::tet_visits, "", "energies, derivatives, rotations and volume constraints of a tet, per frame"},
    {"projections", &WorkCounters::projections, "", "constraints projected, per frame"},
    {"linear_solves", &WorkCounters::linear_solves, "", "systems of the whole body solved, per frame"},
    {"factorisations", &WorkCounters::factorisations, "", "numerical factorisations of such a system, per frame"}};

using Points = Columns<PointRow>;

Points member_error_columns()
{
    Points columns;
    const std::vector<EnsembleMember> members = family();
    for (std::size_t i = 1; i < members.size(); ++i)
        columns.emplace_back(
            "error_" + members[i].name + "_pct", [i](auto& row) -> auto& { return row.members[i - 1]; }, "%",
            "error over the blended vertices against this further reference");
    return columns;
}

Points distance_columns()
{
    Points columns;
    for (std::size_t b = 0; b < budget_iterations.size(); ++b)
        columns.emplace_back(
            fmt::format("from_pbs_{}_pct", budget_iterations[b]), [b](auto& row) -> auto& { return row.from_pbs_pct[b]; }, "%",
            fmt::format("distance from PBS after {} iterations, at the joints outside the overlap", budget_iterations[b]));
    return columns;
}

const Points own_columns = {
    {"vertices", &PointRow::vertices, "", "vertices of the mesh that it is solved on"},
    {"tets", &PointRow::tets, "", "tets of that mesh"},
    {"outcome", &PointRow::outcome, "",
     "finished, not_converged, not_finite, over_time_limit or not_applicable; reference, or not_reached"},
    {"reach_ms", &PointRow::reach_ms, "ms", "wall time from rest to the pose; of the reference: that of all its solutions"},
    {"rounds", &PointRow::rounds, "", "number of timed frames"},
    {"failed_rounds", &PointRow::failed_rounds, "", "frames that did not reach their pose and are left out"},
    {"ms_median", &PointRow::ms_median, "ms",
     "median of the processor time per frame, with the transfer from another mesh to the case's own"},
    {"ms_q1", &PointRow::ms_q1, "ms", "its lower quartile"},
    {"ms_q3", &PointRow::ms_q3, "ms", "its upper quartile"}};

const Points reference_columns = {
    {"reference", &PointRow::reference, "", "name of the reference; empty where none was reached"},
    {"reference_error_joint_pct", &PointRow::reference_error_joint_pct, "%", "bound of the reference's own error at the joints"},
    {"reference_error_l2_pct", &PointRow::reference_error_l2_pct, "%", "bound of the reference's own error over all vertices"},
    {"reference_order", &PointRow::reference_order, "", "order of convergence that is observed"},
    {"reference_order_is_reliable", &PointRow::reference_order_is_reliable, "",
     "that order is credible, and the bound has the safety factor 1.25 instead of 3"},
    {"below_reference_error", &PointRow::below_reference_error, "", "the error is not above the reference's own bound"},
    {"error_whole_joint_pct", &PointRow::error_whole_joint_pct, "%", "error over the blended vertices, those that overlap included"},
    {"masked_share_pct", &PointRow::masked_share_pct, "%",
     "share of the volume that the other errors leave out because the reference overlaps itself there"},
    {"solver_pct", &PointRow::solver_pct, "%", "PBS: distance from its own converged shape, at the joints"},
    {"model_pct", &PointRow::model_pct, "%", "PBS: distance of its converged shape from the reference, at the joints"},
    {"discretisation_pct", &PointRow::discretisation_pct, "%", "PBS: bound of the reference's distance from its limit"},
    {"not_converged_pct", &PointRow::not_converged_pct, "%",
     "PBS: distance of its converged shape from that after half of the iterations"}};

// Later columns, in one group: older records do not have them.
Points columns_of_comparison()
{
    const Points of_point = {{"half", &PointRow::half, "", "training: settings are chosen on this pose; evaluation: they are shown on it"},
                             {"reason", &PointRow::reason, "", "why there is no answer, for readers"}};
    const Points from_limit = {
        {"to_linear_elements_joint_pct", &PointRow::to_linear_elements_pct, "%",
         "distance at the joints from linear elements with the law of the deformers that minimise an energy (Macklin and "
         "Mueller's neo-Hookean), on the case's own tets"}};
    return (of_point + within(&PointRow::work, work_columns) + from_limit + member_error_columns()).in_group("comparison");
}

// These columns are written only if a deformer of the user's own takes part.
const Points columns_of_external = Points{
    {"external", &PointRow::is_external, "", "a deformer of the user's own"},
    {"clock", &PointRow::clock, "",
     "clock of the times: processor (of this process), own (as an external program states them) or wall (of that program, divided "
     "by the number of its poses)"}}.in_group("external");

}  // namespace

BodyMesh::BodyMesh(const pbs::CharacterSource& source, int vertices, const pbs::Character& base)
    : character_(character_with(source, vertices)), base_vertices_(base.mesh.rest.rows())
{
    points_ = pbs::embed(base.mesh.rest, pbs::Triangles(0, 3), character_->mesh);
}

BodyMesh BodyMesh::refined(const pbs::Character& base)
{
    BodyMesh fine(std::make_shared<pbs::Character>(pbs::refined(base)));
    fine.base_vertices_ = base.mesh.rest.rows();
    return fine;
}

BodyMesh BodyMesh::with_smooth_weights(const pbs::Character& base)
{
    auto smooth = std::make_shared<pbs::Character>(base);
    smooth->weights = pbs::weights_by(pbs::WeightKind::smooth, base);
    return BodyMesh(smooth);
}

pbs::Positions BodyMesh::on_base(const pbs::Positions& positions) const
{
    return points_ ? pbs::embedded_positions(*points_, positions, character_->mesh.tets)
                   : pbs::Positions(positions.topRows(base_vertices_));
}

PosedDeformer::PosedDeformer(const Setting& setting, const BodyMesh& mesh, const PosePair& poses, int announced_turns)
    : mesh_(mesh), poses_(poses), deformer_(make_deformer(setting.spec)), has_own_clock_(traits_of(setting.spec).has_own_clock)
{
    deformer_->reset(mesh.character());
    if (!has_own_clock_) return;
    std::vector<pbs::Pose> coming;  // of reach() and of so many turns
    if (deformer_->has_memory()) coming = poses.way;
    coming.push_back(poses.pose);
    for (int turn = 0; turn < announced_turns; ++turn) coming.push_back(turn % 2 == 0 ? poses.neighbour : poses.pose);
    deformer_->foresee(coming);
}

Shape PosedDeformer::reach()
{
    if (deformer_->has_memory())
        for (const pbs::Pose& pose : poses_.way) advance(pose);
    const double start_s = process_cpu_s();
    const pbs::StepSummary step = advance(poses_.pose);
    is_there_ = true;
    work_ = step.work;
    const double seconds = has_own_clock_ ? step.seconds : process_cpu_s() - start_s;
    return {deformer_->positions(), has_arrived_ && deformer_->positions().allFinite(), seconds};
}

std::vector<double> PosedDeformer::turn()
{
    const bool had_arrived = has_arrived_;
    const double start_s = process_cpu_s();
    const pbs::StepSummary step = advance(is_there_ ? poses_.neighbour : poses_.pose);
    if (!mesh_.has_base_vertices()) on_base_ = mesh_.on_base(deformer_->positions());
    const double end_s = process_cpu_s();
    is_there_ = !is_there_;
    if (turns_++ == 0) work_ = step.work;
    const double frame_s = has_own_clock_ ? step.seconds : end_s - start_s;
    return {had_arrived && has_arrived_ ? 1e3 * frame_s : std::numeric_limits<double>::quiet_NaN()};
}

FrameClock PosedDeformer::clock() const
{
    if (!has_own_clock_) return FrameClock::processor;
    const nlohmann::json record = deformer_->record();
    return record.is_object() && record.value("own_times", false) ? FrameClock::own : FrameClock::wall;
}

pbs::StepSummary PosedDeformer::advance(const pbs::Pose& pose)
{
    const pbs::StepSummary step = deformer_->advance(pose, poses_.time_step_s);
    has_arrived_ = step.outcome == pbs::Outcome::finished;
    return step;
}

const Points point_columns = within(&PointRow::of, pose_columns()) + within(&PointRow::key, point_key_columns()) + own_columns +
                             within(&PointRow::error, error_columns) + within(&PointRow::metrics, volume_columns()) + reference_columns +
                             columns_of_comparison() + columns_of_external;

const Points change_columns =
    within(&PointRow::of, pose_columns()) +
    within(&PointRow::key, Columns<SettingKey>{{"change", &SettingKey::deformer, "", "pbs, which is the baseline, or the name of a change"},
                                               {"setting", &SettingKey::tuned, "", "value of the change's own parameter"},
                                               {"iterations", &SettingKey::iterations, "", "of Algorithm 1"}}) +
    Points{{"outcome", &PointRow::outcome, "", "finished or not_finite"},
           {"ms_median", &PointRow::ms_median, "ms", "median of the processor time per frame"},
           {"ms_median_q1", &PointRow::ms_q1, "ms", "its lower quartile"},
           {"ms_median_q3", &PointRow::ms_q3, "ms", "its upper quartile"}} +
    within(&PointRow::error, Columns<ErrorNorms>{error_columns[0], error_columns[1]}) + within(&PointRow::metrics, volume_columns()) +
    distance_columns() +
    Points{{"reference", &PointRow::reference, "",
            "elements of the reference: quadratic or linear, _refined: on the tets cut into eight; or not_reached"},
           {"reference_error_joint_pct", &PointRow::reference_error_joint_pct, "%", "bound on the reference's own error, at the joints"},
           {"masked_share_pct", &PointRow::masked_share_pct, "%", "share of the volume that is left out because the body overlaps itself"}};

Points columns_for(const std::vector<PointRow>& rows)
{
    return std::ranges::any_of(rows, &PointRow::is_external) ? point_columns : point_columns.without("external");
}

const Columns<FamilyRow> family_columns =
    within(&FamilyRow::of, pose_columns()) + within(&FamilyRow::member, family_member_columns()) +
    Columns<FamilyRow>{{"outcome", &FamilyRow::outcome, "", "reached or not_reached"},
                       {"error_bound_pct", &FamilyRow::error_bound_pct, "%",
                        "bound of its own error at the joints, taken from that of the first reference on the same elements"},
                       {"masked_share_pct", &FamilyRow::masked_share_pct, "%", "share of the volume that is left out"},
                       {"solve_s", &FamilyRow::solve_s, "s", "wall time of its solutions"}};

}  // namespace experiments

#include "experiments/studies/work_precision/measured_points.hpp"

#include "experiments/process/machine.hpp"
#include "experiments/run/metrics_table.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "pbs/character/character.hpp"
#include "pbs/character/skinning_weights.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
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
    {"error_joint_pct", &ErrorNorms::joint_pct}, {"error_l2_pct", &ErrorNorms::l2_pct}, {"error_linf_m", &ErrorNorms::linf_m}};

const Columns<WorkCounters> work_columns =
    MEMBER_COLUMNS(WorkCounters, gradients, vertex_visits, tet_visits, projections, linear_solves, factorisations);

using Points = Columns<PointRow>;

Points member_error_columns()
{
    Points columns;
    const std::vector<EnsembleMember> members = family();
    for (std::size_t i = 1; i < members.size(); ++i)
        columns.emplace_back(
            "error_" + members[i].name + "_pct", [i](auto& row) -> auto& { return row.members[i - 1]; });
    return columns;
}

Points distance_columns()
{
    Points columns;
    for (std::size_t b = 0; b < budget_iterations.size(); ++b)
        columns.emplace_back(
            fmt::format("from_pbs_{}_pct", budget_iterations[b]), [b](auto& row) -> auto& { return row.from_pbs_pct[b]; });
    return columns;
}

const Points own_columns = MEMBER_COLUMNS(PointRow, vertices, tets, outcome, reach_ms, rounds, failed_rounds, ms_median, ms_q1, ms_q3);

const Points reference_columns = MEMBER_COLUMNS(PointRow, reference, reference_error_joint_pct, below_reference_error, masked_share_pct);

// Later columns, in one group: older records do not have them.
Points columns_of_comparison()
{
    const Points of_point = MEMBER_COLUMNS(PointRow, half, reason);
    const Points from_limit = {{"to_linear_elements_joint_pct", &PointRow::to_linear_elements_pct}};
    return (of_point + within(&PointRow::work, work_columns) + from_limit + member_error_columns()).in_group("comparison");
}

// These columns are written only if a deformer of the user's own takes part.
const Points columns_of_external = Points{{"external", &PointRow::is_external}, {"clock", &PointRow::clock}}.in_group("external");

template <typename Matrix>
std::vector<typename Matrix::Scalar> numbers_of(const Matrix& matrix)
{
    return {matrix.data(), matrix.data() + matrix.size()};
}

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

RecordedShapes::RecordedShapes(const std::vector<Eigen::VectorXd>& weights)
{
    Eigen::VectorXd largest;
    for (const Eigen::VectorXd& of : weights)
        if (of.size() > 0) largest = largest.size() > 0 ? Eigen::VectorXd(largest.cwiseMax(of)) : of;
    for (int v = 0; v < largest.size(); ++v)
        if (largest(v) > 0.0) measured_.push_back(v);
    for (const Eigen::VectorXd& of : weights) weights_.push_back(of.size() > 0 ? Eigen::VectorXd(of(measured_)) : Eigen::VectorXd());
}

void RecordedShapes::add(const pbs::Positions* positions)
{
    shapes_.emplace_back();
    if (positions) shapes_.back() = (*positions)(measured_, Eigen::all).cast<float>();
}

std::optional<double> RecordedShapes::distance_pct(std::size_t one, std::size_t other, std::size_t reference) const
{
    if (one >= shapes_.size() || other >= shapes_.size() || reference >= weights_.size()) return std::nullopt;
    const Eigen::VectorXd& weights = weights_[reference];
    const Eigen::MatrixX3f &a = shapes_[one], &b = shapes_[other];
    if (weights.size() == 0 || a.rows() != weights.size() || b.rows() != weights.size()) return std::nullopt;
    return 100.0 * std::sqrt(weights.dot((a.cast<double>() - b.cast<double>()).rowwise().squaredNorm()));
}

std::string RecordedShapes::text() const
{
    nlohmann::json all = {{"weights", nlohmann::json::array()}, {"shapes", nlohmann::json::array()}};
    for (const Eigen::VectorXd& weights : weights_) all["weights"].push_back(numbers_of(weights));
    for (const Eigen::MatrixX3f& shape : shapes_) all["shapes"].push_back(numbers_of(shape));
    const std::vector<std::uint8_t> bytes = nlohmann::json::to_cbor(all);
    return {bytes.begin(), bytes.end()};
}

RecordedShapes RecordedShapes::read(const std::string& text)
try {
    RecordedShapes read;
    const nlohmann::json all = nlohmann::json::from_cbor(text);
    for (const std::vector<double> of : all.at("weights")) read.weights_.push_back(Eigen::Map<const Eigen::VectorXd>(of.data(), of.size()));
    for (const std::vector<float> of : all.at("shapes"))
        read.shapes_.push_back(Eigen::Map<const Eigen::MatrixX3f>(of.data(), of.size() / 3, 3));
    return read;
} catch (const nlohmann::json::exception&) {
    throw pbs::InputError("shapes.cbor", 0, "shapes", "", "expected the shapes of a case's points");
}

const Points point_columns = within(&PointRow::of, pose_columns()) + within(&PointRow::key, point_key_columns()) + own_columns +
                             within(&PointRow::error, error_columns) + within(&PointRow::skin, skin_error_columns()) +
                             within(&PointRow::metrics, volume_columns()) + reference_columns + columns_of_comparison() +
                             columns_of_external;

const Points change_columns =
    within(&PointRow::of, pose_columns()) +
    within(
        &PointRow::key,
        Columns<SettingKey>{{"change", &SettingKey::deformer}, {"setting", &SettingKey::tuned}, {"iterations", &SettingKey::iterations}}) +
    MEMBER_COLUMNS(PointRow, outcome, ms_median) + within(&PointRow::error, Columns<ErrorNorms>{error_columns.front()}) +
    within(&PointRow::metrics, Columns<analysis::FrameMetrics>{volume_columns().front()}) + distance_columns() +
    MEMBER_COLUMNS(PointRow, reference_error_joint_pct);

Points columns_for(const std::vector<PointRow>& rows)
{
    return std::ranges::any_of(rows, &PointRow::is_external) ? point_columns : point_columns.without("external");
}

const Columns<FamilyRow> family_columns = within(&FamilyRow::of, pose_columns()) + within(&FamilyRow::member, family_member_columns()) +
                                          MEMBER_COLUMNS(FamilyRow, outcome, error_bound_pct, masked_share_pct, solve_s);

}  // namespace experiments

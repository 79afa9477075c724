#include "experiments/studies/work_precision/posed_deformer.hpp"

#include "experiments/process/machine.hpp"
#include "pbs/character/character.hpp"
#include "pbs/character/skinning_weights.hpp"

#include <limits>

namespace experiments {
namespace {

std::shared_ptr<pbs::Character> character_with(pbs::CharacterSource source, int vertices)
{
    source.vertices = vertices;
    return std::make_shared<pbs::Character>(pbs::make_character(source));
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

}  // namespace experiments

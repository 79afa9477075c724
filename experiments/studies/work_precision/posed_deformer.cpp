#include "experiments/studies/work_precision/posed_deformer.hpp"

#include "experiments/process/cpu_clock.hpp"

#include <limits>

namespace experiments {

PosedDeformer::PosedDeformer(const PointSetting& setting, const BodyMesh& mesh, const PosePair& poses)
    : mesh_(mesh), poses_(poses), deformer_(make_deformer(setting.spec))
{
    deformer_->reset(mesh.character());
}

Shape PosedDeformer::reach()
{
    if (deformer_->has_memory())
        for (const pbs::Pose& pose : poses_.way) advance(pose);
    const double start_s = process_cpu_s();
    const pbs::StepSummary step = advance(poses_.pose);
    is_there_ = true;
    work_ = step.work;
    return {deformer_->positions(), has_arrived_ && deformer_->positions().allFinite(), process_cpu_s() - start_s};
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
    return {had_arrived && has_arrived_ ? 1e3 * (end_s - start_s) : std::numeric_limits<double>::quiet_NaN()};
}

pbs::StepSummary PosedDeformer::advance(const pbs::Pose& pose)
{
    const pbs::StepSummary step = deformer_->advance(pose, poses_.time_step_s);
    has_arrived_ = step.outcome == pbs::Outcome::finished;
    return step;
}

}  // namespace experiments

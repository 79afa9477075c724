#include "experiments/work_precision/posed_deformer.hpp"

#include "experiments/bench/cpu_clock.hpp"

namespace experiments {

PosedDeformer::PosedDeformer(const PointSetting& setting, const pbs::Character& character, const PosePair& poses)
    : substeps_(setting.substeps), poses_(poses), deformer_(make_deformer(setting.spec))
{
    deformer_->reset(character);
}

Shape PosedDeformer::reach()
{
    const double start_s = process_cpu_s();
    const pbs::StepSummary step = advance(poses_.pose);
    is_there_ = true;
    return {deformer_->positions(), step.outcome == pbs::Outcome::finished && deformer_->positions().allFinite(), false,
            process_cpu_s() - start_s};
}

std::vector<double> PosedDeformer::turn()
{
    const double start_s = process_cpu_s();
    advance(is_there_ ? poses_.neighbour : poses_.pose);
    const double end_s = process_cpu_s();
    is_there_ = !is_there_;
    return {1e3 * (end_s - start_s)};
}

pbs::StepSummary PosedDeformer::advance(const pbs::Pose& pose)
{
    pbs::StepSummary step;
    for (int substep = 0; substep < substeps_; ++substep) step = deformer_->advance(pose, poses_.time_step_s / substeps_);
    return step;
}

}  // namespace experiments

#include "experiments/studies/work_precision/posed_deformer.hpp"

#include "experiments/process/cpu_clock.hpp"

#include <limits>

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
    has_arrived_ = step.outcome == pbs::Outcome::finished;
    return {deformer_->positions(), has_arrived_ && deformer_->positions().allFinite(), process_cpu_s() - start_s};
}

std::vector<double> PosedDeformer::turn()
{
    const bool had_arrived = has_arrived_;
    const double start_s = process_cpu_s();
    const pbs::StepSummary step = advance(is_there_ ? poses_.neighbour : poses_.pose);
    const double end_s = process_cpu_s();
    is_there_ = !is_there_;
    has_arrived_ = step.outcome == pbs::Outcome::finished;
    return {had_arrived && has_arrived_ ? 1e3 * (end_s - start_s) : std::numeric_limits<double>::quiet_NaN()};
}

// Its outcome is that of the first substep that did not finish.
pbs::StepSummary PosedDeformer::advance(const pbs::Pose& pose)
{
    pbs::StepSummary whole;
    for (int substep = 0; substep < substeps_; ++substep) {
        const pbs::StepSummary step = deformer_->advance(pose, poses_.time_step_s / substeps_);
        if (whole.outcome == pbs::Outcome::finished) whole = step;
    }
    return whole;
}

}  // namespace experiments

#include "experiments/studies/study.hpp"

namespace experiments {

const std::vector<Study>& studies()
{
    static const std::vector<Study> all = {
        volume_study(), audit_study(), momentum_study(), convergence_study(), stability_study(), artefacts_study(), jiggle_study(),
        stiffness_study(), setup_study(), ambiguity_study(), frames_study(), timing_study(), verification_study(), fit_study(),
        work_precision_study(), bench_study(), equal_quality_study(), features_study(), scale_study(), ensemble_study()};
    return all;
}

}  // namespace experiments

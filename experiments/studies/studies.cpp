#include "experiments/studies/study.hpp"

namespace experiments {

const std::vector<Study>& studies()
{
    static const std::vector<Study> all = {
        {"volume",
         "volume change of LBS, DQS, PBS (1 to 96 iterations, jiggling, as printed) and the FEM by pose, on the limb and on the human",
         "C01, C02", "some 5 minutes (--quick: 25 frames a second of the clip), 20 (--full: 100)", plan_volume_study},
        {"verification",
         "the FEM reference against theory and published benchmarks: patch tests, manufactured solutions, beams, sphere, plates",
         "none: how far the reference itself may be trusted", "some 30 seconds (--quick), 5 minutes (--full)", plan_verification_study,
         true, conclude_verification_study},
    };
    return all;
}

}  // namespace experiments

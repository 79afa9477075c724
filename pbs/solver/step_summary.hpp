// What one step did, whole: residuals, why it stopped, how long it took.
#pragma once

#include <vector>

namespace pbs {

struct Residuals {
    double stretch_rms = 0.0;  // rms of l / l0 - 1
    double volume_rms = 0.0;   // rms of V / V0 - 1
    double bind_rms_m = 0.0;   // rms of |x_i - q_i| - d_i [m]
};

enum class Outcome { finished, not_finite, not_converged };
const char* to_string(Outcome outcome);

struct StepSummary {
    int iterations = 0;
    Outcome outcome = Outcome::finished;
    double sleeping_share = 0.0;     // of stretch and volume constraints that were left out
    int wakings = 0;                 // how often the step was redone because some of them were needed
    double seconds = 0.0;            // wall time of the step
    std::vector<Residuals> history;  // one an iteration, where asked
};

}  // namespace pbs

// C06: the same poses with the weights of Eq. 2, or of the scene's weights file in their place, and with rigid weights, which bind every
// vertex to its nearest bone alone.
//   for (const analysis::Measurement& measurement : compare_weights(of).measurements) ...
// Measured are, at each joint, the jump of strain between neighbouring tets and the bending of the skin (analysis/metrics/error_norms.hpp);
// for the whole body, the absolute volume change; and the number of iterations after which PBS stays within the tolerance of its residual,
// by the rule of shared/iteration_path.hpp with the two blends as initial guesses. Each value is a ratio of Eq. 2 to rigid weights, with
// its spread over orders, precisions and meshes; for iterations over meshes only.
#pragma once

#include "analysis/metrics/error_norms.hpp"
#include "analysis/verdicts/measurement.hpp"
#include "experiments/studies/artefacts/artefact_case.hpp"
#include "experiments/studies/shared/iteration_path.hpp"

namespace experiments {

inline constexpr int most_weight_iterations = 1000;

struct SmoothnessRow {
    std::string body;
    int vertices = 0;
    std::string weights, pose, joint;
    ArtefactDeformer deformer;
    analysis::Smoothness smoothness;
    double volume_abs_change_pct = 0.0;
};
struct WeightIterations {
    ArtefactPlace place;
    Reached paper, rigid;
};
extern const analysis::Columns<SmoothnessRow> smoothness_columns;           // smoothness.csv
extern const analysis::Columns<WeightIterations> weight_iteration_columns;  // iterations.csv

struct WeightsComparison {
    std::vector<analysis::Measurement> measurements;
    std::vector<SmoothnessRow> smoothness;  // the terms of the ratios
    std::vector<WeightIterations> iterations;
};

WeightsComparison compare_weights(const ArtefactCase& of);

}  // namespace experiments

// C06: the same poses with the weights of Eq. 2, or of the scene's weights file in their place, and with every vertex on its nearest bone
// alone.
//   for (const analysis::Measurement& figure : compare_weights(of).figures) ...
// At each joint: the jump of strain between neighbouring tets and the bending of the skin (analysis/smoothness.hpp); of the whole body the
// absolute volume change; and the iterations after which PBS stays within the tolerance of its residual, by the residual and the rule of
// the study of convergence (shared/path_figures.hpp), with the blends by both weights as its two starts. Each is given as Eq. 2 over
// rigid, with the spread over orders, precisions and meshes; of iterations over meshes alone.
#pragma once

#include "analysis/measurement.hpp"
#include "experiments/studies/artefacts/artefact_case.hpp"

namespace experiments {

inline constexpr int most_weight_iterations = 1000;

struct WeightsComparison {
    std::vector<analysis::Measurement> figures;
    analysis::CsvTable smoothness, iterations;  // what the ratios are of
};

WeightsComparison compare_weights(const ArtefactCase& of);

}  // namespace experiments

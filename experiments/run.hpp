// One scene: character, motion and deformers in; a run's directory out (metrics.csv, iterations.csv, run.json, frames/).
#pragma once

#include "experiments/scene.hpp"

#include <string>
#include <vector>

namespace experiments {

struct RunResult {
    int frames = 0;
    double seconds = 0.0;
    std::string breakdown;           // the first deformer and frame that were not finite, with the first such vertex; empty: none
    std::string unreached;           // the first step that did not converge, or reference with inverted tets, and the worst tet. It is on
                                     // record, its frame is marked and, where it was not reached, compared with nothing
    std::vector<std::string> lines;  // a summary for the terminal, one line a deformer
};

// Negative controls (the printed forms, linear elasticity) may break down: it is on record, under outcome.broken_frames, and nothing else.
// Overwrites the records in `folder`. Whole files only: each is written beside and renamed, run.json last.
RunResult run_scene(const Scene& scene, const std::string& folder);

}  // namespace experiments

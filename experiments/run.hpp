// One scene: character, motion and deformers in; a run's directory out (metrics.csv, iterations.csv, run.json, frames/).
#pragma once

#include "experiments/scene.hpp"

#include <string>
#include <vector>

namespace experiments {

struct RunResult {
    int frames = 0;
    double seconds = 0.0;
    std::string breakdown;           // the first deformer and frame that were not finite; empty: none. A step that does not converge is no
                                     // breakdown: it is on record, its frame is marked and compared with nothing
    std::vector<std::string> lines;  // a summary for the terminal, one line a deformer
};

// Overwrites the records in `folder`. Whole files only: each is written beside and renamed, run.json last.
RunResult run_scene(const Scene& scene, const std::string& folder);

}  // namespace experiments

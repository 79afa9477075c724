// One scene: character, motion and deformers in; a run's directory out (metrics.csv, iterations.csv, run.json, frames/).
#pragma once

#include "experiments/scene/scene.hpp"

#include <string>
#include <vector>

namespace experiments {

// A bad frame was not reached (the step did not converge; as a reference it is compared with nothing) or is a converged reference's with
// inverted tets (it is compared, and marked by its count). Both are on record. `run`, `check` and `reproduce` end with exit status 3 for
// either and for a breakdown, but for runs of a study whose results bad frames are (StudyRun::bad_frames_are_results).
struct RunResult {
    int frames = 0;
    double seconds = 0.0;
    std::string breakdown;           // the first deformer and frame that were not finite, with the first such vertex; empty: none
    std::string bad_frame;           // the first finite frame that is not to be trusted, what is wrong and the worst tet; empty: none
    std::vector<std::string> lines;  // a summary for the terminal, one line a deformer

    // Of a run that was expected to finish with each frame sound: the breakdown, else the bad frame; empty: it did.
    const std::string& failure() const { return breakdown.empty() ? bad_frame : breakdown; }
};

// Negative controls (the printed forms, linear elasticity) may break down: it is on record, under outcome.broken_frames, and nothing else.
// Overwrites the records in `folder`. Whole files only: each is written beside and renamed, run.json last.
RunResult run_scene(const Scene& scene, const std::string& folder);

}  // namespace experiments

// Runs one scene, from its character, motion and deformers to the folder of a run (metrics.csv, iterations.csv,
// run.json, frames/).
//   const RunResult result = run_scene(read_scene("arm.toml", {}), "results/arm");
//   if (!result.failure().empty()) ...
#pragma once

#include "analysis/records/provenance.hpp"
#include "experiments/scene/scene.hpp"
#include "pbs/system/source_file.hpp"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <vector>

namespace experiments {

// A bad frame is one that was not reached (its step did not converge; such a frame of a reference is compared with
// nothing), or a frame of a converged reference with inverted tets (it is compared, and marked by their number). Both
// are recorded. `run`, `check` and `reproduce` end with exit status 3 for bad frames and for breakdowns. In runs of a
// study that expects bad frames (StudyRun::bad_frames_are_results), `reproduce` only lists them
// (reproduce/reproduce.hpp).
struct RunResult {
    int frames = 0;
    double seconds = 0.0;
    std::string
        breakdown;  // the first deformer and frame that were not finite, with the first such vertex; empty: none
    std::string bad_frame;  // the first bad frame, with its worst tet and the number of bad frames of each deformer;
                            // empty: none
    std::vector<std::string> lines;  // a summary for the terminal, one line per deformer
    bool was_interrupted = false;    // and finished with the frames, or the frames of the reference, up to then

    // Why a run failed that was expected to finish without bad frames: the breakdown, else the bad frame. Empty: it did
    // not fail.
    const std::string& failure() const { return breakdown.empty() ? bad_frame : breakdown; }
};

// What an interruption does to a run. stop: it ends the program, and the tables keep all frames except those of the
// last second. finish_early: it ends the solving of a reference with a budget, or else the motion after the present
// frame, and the records of what is finished are written whole.
enum class WhenInterrupted { stop, finish_early };

// Runs the scene and overwrites the records in `folder`. Each file is written whole or not at all, run.json last. A
// breakdown of a negative control (the printed forms, linear elasticity) is only recorded, under outcome.broken_frames.
// remarks: what the caller has to say about the scene, which is printed and recorded before the remarks of the run.
// model: the scene's rigged model, if the caller has read it; its bytes are kept until the first frame.
RunResult run_scene(const Scene& scene, const std::string& folder, const Remarks& remarks = {},
                    WhenInterrupted when_interrupted = WhenInterrupted::stop,
                    std::optional<pbs::SourceFile> model = {});

// The parts of run.json that are the same for all runs.
//   run["provenance"] = run_provenance(threads);   run["outcome"].update(run_end(stopwatch.seconds()));

// The version of run.json. Since 3, a part of the body may be left out of the errors (largest_masked_share_pct): up to
// revision c31e4555 what overlaps in the reference, since then the tips of its creases. The outcome counts the frames
// with overlap (frames_with_overlap).
inline constexpr int run_schema = 3;

// The provenance of this build and machine, with the BLAS in use and the versions of the libraries that make characters
// and frames (empty for a library that the build left out). threads: that the run uses.
analysis::Provenance run_provenance(int threads);

// ended_utc: now, as ISO 8601 to the second; wall_s: as given [s].
nlohmann::json run_end(double wall_s);

}  // namespace experiments

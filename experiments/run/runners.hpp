// The deformers of a run, each with its state and with the sums over its frames that the summary on the terminal needs.
//   std::vector<Runner> runners = make_runners(scene, character, cost, folder, WhenInterrupted::stop);
//   for (Runner& runner : runners) runner.steps.add(runner.deformer->advance(pose, dt_s), step);
#pragma once

#include "experiments/deformers/registry.hpp"
#include "experiments/run/frame_measurement.hpp"
#include "experiments/run/run.hpp"
#include "experiments/run/run_folder.hpp"
#include "experiments/run/spread_reference.hpp"

#include <algorithm>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace experiments {

struct Runner {
    DeformerSpec spec;
    DeformerTraits traits;
    std::unique_ptr<Deformer> deformer;
    pbs::FrameStep steps = {};  // since the last frame
    double lowest_change_pct = std::numeric_limits<double>::infinity(), highest_change_pct = -lowest_change_pct;
    int most_inverted = 0;

    void add_volume_change(double change_pct)  // of one more frame
    {
        lowest_change_pct = std::min(lowest_change_pct, change_pct);
        highest_change_pct = std::max(highest_change_pct, change_pct);
    }
    // Curved elements are judged at their quadrature points, since their vertices alone may form an inverted tet. False
    // for a deformer that solves no equations.
    bool has_inverted_flesh(const FrameMeasurer& measurer) const;
    // A line for the terminal: the range of the volume over the frames that were reached, out of so many.
    std::string summary(int frames) const;
};

// Makes and resets all deformers of the scene. The reference comes first, so that the errors of a frame can be
// measured. folder: that of the run, in which a reference with a budget keeps its solved frames.
std::vector<Runner> make_runners(const Scene& scene, const pbs::Character& character, CostRecord& cost,
                                 const std::string& folder, WhenInterrupted when_interrupted);

// The budget of a reference whose solved frames a run of the scene keeps in its folder, so that they are found again.
ReferenceBudget reference_budget(const DeformerSpec& reference, const pbs::Character& character,
                                 const std::string& folder, double seconds, bool goes_on_without_the_rest);

// The vertices whose positions at least one of the deformers is given, #V; empty: there are none. Errors leave them
// out.
std::vector<bool> prescribed_by_any(const std::vector<Runner>& runners);

}  // namespace experiments

// The deformers of a run, and what their frames add up to.
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
    // For the terminal: the range of its volume, over the frames that it reached, of so many.
    std::string summary(int frames) const;
};

// Sets up all deformers of the scene. The reference comes first, so that a frame's errors can be measured. folder: of
// the run, in which a reference with a budget keeps its solved frames.
std::vector<Runner> make_runners(const Scene& scene, const pbs::Character& character, CostRecord& cost,
                                 const std::string& folder, WhenInterrupted when_interrupted);

// The budget of a reference whose solved frames a run of the scene keeps in its folder, so that they are found again.
ReferenceBudget reference_budget(const DeformerSpec& reference, const pbs::Character& character,
                                 const std::string& folder, double seconds, bool goes_on_without_the_rest);

// Vertices whose positions any of the deformers is given, #V; empty: none. Errors leave them out.
std::vector<bool> prescribed_by_any(const std::vector<Runner>& runners);

}  // namespace experiments

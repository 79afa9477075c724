// One setting of one deformer, moving back and forth between a pose and that of the frame before: its shape in the pose, and the time per
// frame. A solver that begins in its last state (finite elements) is thus timed on the motion of one frame, as in a clip.
//   PosedDeformer deformer(setting, character, motion);
//   const Shape shape = deformer.reach();      // from rest, however long it takes
//   take_turns({[&] { return deformer.turn(); }}, rounds);
// The time is processor time over all threads of the process, so that other work on the machine affects it less.
#pragma once

#include "experiments/studies/shared/posed_character.hpp"
#include "experiments/studies/work_precision/point_setting.hpp"

#include <memory>

namespace experiments {

struct PosePair {
    pbs::Pose pose, neighbour;  // neighbour: of the frame before
    double time_step_s = 0.01;
};

class PosedDeformer {
public:
    // The character and the poses outlive it.
    PosedDeformer(const PointSetting& setting, const pbs::Character& character, const PosePair& poses);

    Shape reach();
    // One number, the processor time of the next frame [ms]. Not a number where the frame did not arrive, or the one before it did not.
    std::vector<double> turn();

private:
    pbs::StepSummary advance(const pbs::Pose& pose);

    int substeps_;
    const PosePair& poses_;
    std::unique_ptr<Deformer> deformer_;
    bool is_there_ = false;  // in the pose
    bool has_arrived_ = true;
};

}  // namespace experiments

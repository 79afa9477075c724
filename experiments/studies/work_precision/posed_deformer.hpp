// One setting of one deformer, going back and forth between a pose and the one of the frame before: its shape in the pose, and the time of
// a frame. So a solver that starts from where it was (finite elements) is timed on a frame's worth of motion, as in a clip.
//   PosedDeformer deformer(setting, character, motion);
//   const Shape shape = deformer.reach();      // from rest, whatever the way takes
//   take_turns({[&] { return deformer.turn(); }}, rounds);
// Time: of the processor, all threads of the process, so that other work on the machine stretches it less.
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
    // One number: processor time of the next frame [ms]; not a number where it did not arrive, or set out from where the last did not.
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

// One setting of one deformer, moving back and forth between a pose and that of the frame before: its shape in the pose, the time per
// frame, and the work per frame. A solver that begins in its last state (finite elements) is thus timed on the motion of one frame, as in a
// clip. A frame ends with the positions of the case's own vertices: where the deformer runs on another mesh, the transfer is part of the
// time.
//   PosedDeformer deformer(setting, mesh, motion);
//   const Shape shape = deformer.reach();      // from rest, however long it takes
//   take_turns({[&] { return deformer.turn(); }}, rounds);
// The time is processor time over all threads of the process, so that other work on the machine affects it less. A deformer that works in
// another process (DeformerTraits::has_own_clock) has the time that it states instead. It runs on the case's own mesh only.
#pragma once

#include "experiments/studies/shared/posed_character.hpp"
#include "experiments/studies/work_precision/body_mesh.hpp"
#include "experiments/studies/work_precision/frame_clock.hpp"

#include <memory>

namespace experiments {

struct PosePair {
    pbs::Pose pose, neighbour;  // neighbour: of the frame before
    double time_step_s = 0.01;
    std::vector<pbs::Pose> way = {};  // the poses before, through which a deformer with memory goes to its first pose
};

class PosedDeformer {
public:
    // The mesh and the poses outlive it. announced_turns: the number of turns that follow reach(); a program computes them in the same
    // call.
    PosedDeformer(const PointSetting& setting, const BodyMesh& mesh, const PosePair& poses, int announced_turns = 0);

    Shape reach();  // on its own mesh; a deformer with memory takes the way
    // One number, the time of the next frame [ms]. Not a number where the frame did not arrive, or the one before it did not.
    std::vector<double> turn();
    // The work of the first turn, which does not depend on the number of turns; before it, of reach().
    const pbs::WorkCounters& work() const { return work_; }
    bool has_own_clock() const { return has_own_clock_; }
    FrameClock clock() const;  // of the times; known after reach()

private:
    pbs::StepSummary advance(const pbs::Pose& pose);

    const BodyMesh& mesh_;
    const PosePair& poses_;
    std::unique_ptr<Deformer> deformer_;
    pbs::Positions on_base_;  // [m], of the case's own vertices
    pbs::WorkCounters work_;
    bool has_own_clock_;
    int turns_ = 0;
    bool is_there_ = false;  // in the pose
    bool has_arrived_ = true;
};

}  // namespace experiments

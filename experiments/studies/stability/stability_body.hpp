// The body of a cell and the way it is led: poses, blended shapes and bind points of each step.
//   StabilityBody body(cell);
//   for (int step = 0; step < body.steps(); ++step) driven->advance(body.drive(step), cell.time_step_s);
#pragma once

#include "experiments/scene/scene.hpp"
#include "experiments/studies/stability/stability_cell.hpp"
#include "pbs/character/character.hpp"

namespace experiments {

// What every method is told in a step.
struct Drive {
    const pbs::Pose& pose;
    const pbs::Positions& blended;      // LBS, or the start's shape [m], #V x 3
    const pbs::Positions& bind_points;  // posed q_i [m], #V x 3
};

// A limb, or a character landing from a jump: what cells of `body` begin with.
Scene stability_scene(const std::string& body);

// Bodies are kept from one cell to the next: the same tets for all.
const pbs::Character& stability_character(const StabilityCell& cell);

class StabilityBody {
public:
    explicit StabilityBody(const StabilityCell& cell);

    const pbs::Character& character() const { return character_; }
    int disturbed_steps() const { return static_cast<int>(way_.size()); }
    int steps() const { return disturbed_steps() + still_steps_; }
    Drive drive(int step);  // until the next call
    double diagonal_m() const { return diagonal_m_; }

private:
    const pbs::Character& character_;
    std::vector<pbs::Pose> way_;
    Start start_;
    int still_steps_, posed_ = -1;
    double diagonal_m_;
    pbs::Positions blended_, bind_points_;
};

}  // namespace experiments

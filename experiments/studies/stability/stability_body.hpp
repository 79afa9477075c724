// The body of a cell and its motion: the pose, the blended shape and the bind points of each step.
//   StabilityBody body(cell);
//   for (int step = 0; step < body.steps(); ++step) driven->advance(body.drive(step), cell.time_step_s);
#pragma once

#include "experiments/scene/scene.hpp"
#include "experiments/studies/stability/stability_cell.hpp"
#include "pbs/character/character.hpp"

namespace experiments {

// The input of every method in a step.
struct Drive {
    const pbs::Pose& pose;
    const pbs::Positions& blended;      // LBS, or the broken initial shape [m], #V x 3
    const pbs::Positions& bind_points;  // posed q_i [m], #V x 3
};

// The scene of the cells of `body`: a limb, or a character that lands from a jump.
Scene stability_scene(const std::string& body);

// Characters are cached, so that all cells have the same tets.
const pbs::Character& stability_character(const StabilityCell& cell);

class StabilityBody {
public:
    explicit StabilityBody(const StabilityCell& cell);

    const pbs::Character& character() const { return character_; }
    int disturbed_steps() const { return static_cast<int>(way_.size()); }
    int steps() const { return disturbed_steps() + still_steps_; }
    Drive drive(int step);  // valid until the next call
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

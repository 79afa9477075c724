// The deformer: what moves a character's vertices. LBS, DQS, PBS and the FEM references are deformers, so every case, study, metric and
// figure works for each of them, and a new one is one folder and one registration.
#pragma once

#include "pbs/character/character.hpp"
#include "pbs/solver/step_summary.hpp"

#include <nlohmann/json.hpp>

#include <vector>

namespace experiments {

class Deformer {
public:
    virtual ~Deformer() = default;

    virtual void reset(const pbs::Character& character) = 0;  // set-up and initial state; the character outlives the deformer
    virtual pbs::StepSummary advance(const pbs::Pose& pose, double dt_s) = 0;
    virtual const pbs::Positions& positions() const = 0;  // [m], #V x 3

    // The poses of the calls of advance to come, in their order: a deformer without memory may work ahead, several frames at once.
    virtual void foresee(const std::vector<pbs::Pose>& /*poses*/) {}

    // What the next call of advance sets out from, however broken, in place of what the deformer would take [m], #V x 3, in the world.
    // The nonlinear finite elements in equilibrium alone do; all others ignore it.
    virtual void start_from(const pbs::Positions& /*shape*/) {}

    // The next positions depend on the last: such a deformer sees every step, the others see frames only.
    virtual bool has_memory() const { return false; }

    // Vertices this deformer is told where to be (the FEM's attachment), #V; empty: none.
    virtual std::vector<bool> prescribed() const { return {}; }
    // What belongs on record beside the frames: grip of each bone, solver, sizes. Null: nothing.
    virtual nlohmann::json record() const { return nullptr; }
};

}  // namespace experiments

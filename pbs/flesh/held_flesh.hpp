// Elastic flesh that the bones hold, with what a minimiser of its energy keeps for all frames: the energy, its Laplacian's factor, and
// weights for an initial guess.
//   const HeldFlesh flesh(mesh, smooth_springs(character, {}).springs, bones, {.poisson = 0.45});
//   flesh.hold().centres(pose, centres);
#pragma once

#include "pbs/flesh/flesh_energy.hpp"
#include "pbs/skinning/weights.hpp"

namespace pbs {

// The shape at which a minimiser begins. smooth_dqs: dual quaternion skinning with smooth weights, those of HeldFlesh::smooth_weights. lbs:
// linear blend skinning with the character's weights.
enum class FleshStart { smooth_dqs, lbs };

struct HeldFleshOptions {
    double poisson = 0.45;
    double volume_share = 0.6;  // of lambda in the Laplacian: see flesh_laplacian
};

class HeldFlesh {
public:
    // InputError: a tet without volume, poisson outside [0, 1/2), no spring inside the tets, or the module of CHOLMOD is missing.
    HeldFlesh(const TetMesh& mesh, const BoneSprings& springs, int bones, const HeldFleshOptions& options);

    const FleshEnergy& energy() const { return energy_; }
    const BoneHold& hold() const { return hold_; }
    const CholeskyFactor& factor() const { return factor_; }

    // The weights of a bone minimise the same quadratic energy of one number per vertex, which the springs pull to 1 at this bone and to 0
    // at the others. The weights of a vertex add up to 1 and vary smoothly. Those below 1e-3 are left out. A vertex that no spring reaches
    // has the weights of `otherwise`.
    Weights smooth_weights(const Weights& otherwise) const;

private:
    BoneHold hold_;
    FleshEnergy energy_;
    CholeskyFactor factor_;
};

}  // namespace pbs

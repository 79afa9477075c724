// Elastic flesh that the bones hold, with what a minimiser of its energy keeps for all frames: the energy, its Laplacian's factor, and
// weights for an initial guess.
//   const HeldFlesh flesh(mesh, smooth_springs(character, {}).springs, bones, {.poisson = 0.45});
//   flesh.hold().centres(pose, centres);
#pragma once

#include "pbs/flesh/flesh_energy.hpp"
#include "pbs/skinning/weights.hpp"

#include <Eigen/SparseCore>

#include <vector>

namespace pbs {

// The Cholesky factor of a sparse symmetric positive definite matrix, computed once by CHOLMOD (Y. Chen, T. Davis, W. Hager, S.
// Rajamanickam, Algorithm 887, ACM TOMS 35(3), 2008) and kept. The factor goes into code of this library, which solves for x, y and z side
// by side.
// L L^T = P A P^T. L is stored by columns, the diagonal first, rows ascending.
struct CholeskyFactor {
    std::vector<int> order;       // row k of L belongs to row order[k] of A, #rows
    std::vector<int> first, row;  // first: #rows + 1
    std::vector<double> value;

    bool usable() const { return !first.empty(); }  // false: A is not positive definite in double
};

// lower: the lower triangle of A, compressed. CHOLMOD is in the module pbskin_cholmod; an InputError where that is missing.
CholeskyFactor cholesky_factor(const Eigen::SparseMatrix<double>& lower);

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

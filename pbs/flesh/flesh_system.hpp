// Elastic flesh that the bones hold, and its energy as a minimiser needs it.
//   const BoneSprings springs = bone_springs(character, SpringPlacement::smooth, {}).springs;
//   const HeldFlesh flesh(mesh, springs, bones, {.poisson = 0.45});
#pragma once

#include "pbs/flesh/flesh_energy.hpp"
#include "pbs/flesh/flesh_kernels.hpp"
#include "pbs/packed/rows.hpp"
#include "pbs/skinning/weights.hpp"

#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

namespace pbs {

// The Cholesky factor of a sparse symmetric positive definite matrix, computed once by CHOLMOD (Y. Chen, T. Davis, W.
// Hager, S. Rajamanickam, Algorithm 887, ACM TOMS 35(3), 2008) and kept. The factor goes into code of this library,
// which solves for x, y and z side by side. L L^T = P A P^T. L is stored by columns, the diagonal first, rows
// ascending.
struct CholeskyFactor {
    std::vector<int> order;       // row k of L belongs to row order[k] of A, #rows
    std::vector<int> first, row;  // first: #rows + 1
    std::vector<double> value;

    bool usable() const { return !first.empty(); }  // false: A is not positive definite in double
};

// lower: the lower triangle of A, compressed. order: of the rows, as in the factor; empty: CHOLMOD chooses one. CHOLMOD
// is in the module pbskin_cholmod; an InputError where that is missing.
CholeskyFactor cholesky_factor(const Eigen::SparseMatrix<double>& lower, const std::vector<int>& order = {});

// How many columns of L, from `column` on, have the same rows below the last of them: a supernode. At most `widest`.
int width_of_supernode(const CholeskyFactor& factor, int column, int widest);

struct HeldFleshOptions {
    double poisson = 0.45;
    double volume_share = 0.6;  // of lambda in the Laplacian: see flesh_laplacian
};

// Elastic flesh that the bones hold, with what a minimiser of its energy keeps for all frames: the energy, its
// Laplacian's factor, and weights for an initial guess.
//   const BoneSprings springs = bone_springs(character, SpringPlacement::smooth, {}).springs;
//   const HeldFlesh flesh(mesh, springs, bones, {.poisson = 0.45});
//   flesh.hold().centres(pose, centres);
class HeldFlesh {
public:
    // InputError: a tet without volume, poisson outside [0, 1/2), no spring inside the tets, or the module of CHOLMOD
    // is missing.
    HeldFlesh(const TetMesh& mesh, const BoneSprings& springs, int bones, const HeldFleshOptions& options);

    const FleshEnergy& energy() const { return energy_; }
    const BoneHold& hold() const { return hold_; }
    const CholeskyFactor& factor() const { return factor_; }

    // The weights of a bone minimise the same quadratic energy of one number per vertex, which the springs pull to 1 at
    // this bone and to 0 at the others. The weights of a vertex add up to 1 and vary smoothly. Those below 1e-3 are
    // left out. A vertex that no spring reaches has the weights of `otherwise`.
    Weights smooth_weights(const Weights& otherwise) const;

private:
    BoneHold hold_;
    FleshEnergy energy_;
    CholeskyFactor factor_;
};

class ProjectiveEnergy;

// The energy of the flesh (flesh_energy.hpp, or projective_dynamics.hpp) as a minimiser needs it: values, gradients and
// steps of a quasi-Newton method, on rows of numbers. One implementation is plain, the other one packed; both have the
// same constants.
//   auto system = make_flesh_system<float>(mesh, energy, factor, true, threads);
//   system->set_centres(centres);
//   system->load(positions, x);
//   double e = system->value_and_gradient(x, g);
//   system->precondition(g);   // g <- H^-1 g
template <typename Scalar>
class FleshSystem : public RowSystem<Scalar> {
public:
    // c_i [m], #V x 3; packed: their mean becomes the origin of the rows
    virtual void set_centres(const Positions& centres) = 0;
    // over Young's modulus [m^3], [m^2]
    virtual double value_and_gradient(const Rows<Scalar>& x, Rows<Scalar>& gradient) = 0;
    virtual void precondition(Rows<Scalar>& residual) = 0;  // [m^2] -> [m]
    virtual double dot(const Rows<Scalar>& a, const Rows<Scalar>& b) const = 0;
    virtual void add(double factor, const Rows<Scalar>& a, Rows<Scalar>& to) const = 0;  // to += factor * a
    // tets of the last gradient whose shapes the packed formulae left to the plain code
    virtual int refused() const { return 0; }
    // The norm of a step that ends an iteration [m]: this share of the first one, or a few roundings of the positions,
    // as at rest.
    double smallest_step(const Rows<Scalar>& x, double share, double first) const
    {
        constexpr double roundings = 4.0;  // measured at rest: 0.4 for a bar of 208 vertices in every arithmetic
        return std::max(share * first, roundings * std::numeric_limits<Scalar>::epsilon() * std::sqrt(dot(x, x)));
    }

protected:
    using RowSystem<Scalar>::RowSystem;
};

// Energy: FleshEnergy or ProjectiveEnergy. factor: of flesh_laplacian. packed: false is plain code, which is in double
// and exists for Scalar double alone.
template <typename Scalar, typename Energy>
std::unique_ptr<FleshSystem<Scalar>> make_flesh_system(const TetMesh& mesh, const Energy& energy,
                                                       const CholeskyFactor& factor, bool packed, int threads);

// Solves L L^T x = b with a kept factor, for x, y and z side by side.
//   const TriangularSolve<float> solve(factor, place);
//   solve.apply(rows);   // b in, x out
// Columns of L with the same rows below (supernodes) are processed together, so that each row is read and written once
// for all of them.
template <typename Scalar>
class TriangularSolve {
public:
    // place: where row i of the matrix lies among the rows that are passed to apply, #rows.
    TriangularSolve(const CholeskyFactor& factor, const std::vector<int>& place);

    void apply(Scalar* rows);  // four numbers per row

private:
    std::vector<Supernode> supernodes_;
    std::vector<std::uint32_t> below_;  // rows below the supernodes' triangles
    std::vector<Scalar> values_;
    std::vector<std::uint32_t> place_;  // of row k of L
    Rows<Scalar> work_;
};

// The same for any number of right-hand sides: the plain implementation, by Eigen's loop per entry of L, in double.
Eigen::MatrixXd solve_plainly(const CholeskyFactor& factor, const Eigen::MatrixXd& b);

}  // namespace pbs

// Elastic flesh as compliant constraints, and one pass of XPBD over them: the springs of the bones (bone_springs.hpp) and the two coupled
// constraints of each tet (flesh_energy.hpp). One implementation is plain, the other one packed; both have the same constants.
//   const XpbdFlesh flesh(mesh, energy, hold, material, time_step);
//   auto system = make_xpbd_system<float>(mesh, flesh, Arithmetic::packed_f32, threads);
//   system->set_targets(targets);
//   system->load(positions, x);
//   system->iterate(x, true);
//
// One visit of a tet solves for the changes of its two multipliers, with inverse masses w, W = diag(w) and k = lambda V, mu V (Eq. 18 of
// M. Macklin, M. Mueller, N. Chentanez, XPBD, MIG 2016, for two constraints at once):
//   (k_a dC_a W dC_b^T + delta_ab) dlambda_b = -k_a C_a - lambda_a + k_a dC_a r,      dx = W dC^T dlambda - r.
// r = W (p - dC^T lambda) is what the tet has moved its vertices in excess of its multipliers' forces at its present shape (p: the forces
// that it has applied). XPBD neglects r, which is why it does not converge to implicit Euler; with r it does (Y. Chen et al., Primal
// extended position based dynamics for hyperelasticity, MIG 2023, keep this residual for all constraints at once; here each tet corrects
// its own). The constraints of the bones are linear, so that their r is zero.
#pragma once

#include "pbs/flesh/bone_springs.hpp"
#include "pbs/flesh/flesh_energy.hpp"
#include "pbs/packed/rows.hpp"

#include <memory>

namespace pbs {

// The constraints and the masses, over Young's modulus.
struct XpbdFlesh {
    // InputError: a tet without volume, or time_step not above 0.
    XpbdFlesh(const TetMesh& mesh, const FleshEnergy& energy, const BoneHold& hold, const FleshMaterial& material, double time_step);

    FleshMaterial material;
    std::vector<NeoHookeanTet> tets;
    HoldModes hold;
    std::vector<int> first_mode;  // of each tet, #T + 1
    // Inverse masses w_i = time_step^2 / D_i [1/m], #V. D_i is the stiffness of the energy along vertex i without its volume term. The
    // limit does not depend on the masses, and with these a small tet is no stiffer than a large one in units of its masses. 1: no tet.
    Eigen::VectorXd w;
};

// One constraint block: the springs of a tet or its pair of neo-Hookean constraints.
struct XpbdVisit {
    bool is_hold;
    int tet;
};

template <typename Scalar>
class XpbdSystem {
public:
    virtual ~XpbdSystem() = default;

    virtual Rows<Scalar> rows() const = 0;                   // of positions and w; in places without a vertex w is 1
    virtual void set_targets(const Positions& targets) = 0;  // of the hold's modes [m]; packed: their mean becomes the origin of the rows
    virtual void load(const Positions& x, Rows<Scalar>& rows) const = 0;
    virtual void store(const Rows<Scalar>& rows, Positions& x) const = 0;
    virtual void forget() = 0;  // sets all multipliers, and the forces that tets have applied, to zero
    // Visits every constraint once. with_residual: r is corrected; otherwise it is neglected, as published.
    virtual void iterate(Rows<Scalar>& x, bool with_residual) = 0;
    virtual std::vector<XpbdVisit> visits() const = 0;  // an order in which one after the other gives the same result
};

// Scalar is that of `arithmetic` (unchecked).
template <typename Scalar>
std::unique_ptr<XpbdSystem<Scalar>> make_xpbd_system(const TetMesh& mesh, const XpbdFlesh& flesh, Arithmetic arithmetic, int threads);

}  // namespace pbs

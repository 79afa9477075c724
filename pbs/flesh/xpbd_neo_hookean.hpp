// Elastic flesh in equilibrium by XPBD with the two neo-Hookean constraints of M. Macklin, M. Mueller (MIG 2021). Below
// are the constraints and the equations of one visit. A frame is a sequence of steps of implicit Euler without inertia
// from frame to frame: step n begins at the predicted positions y = x_n + b (x_n - x_{n-1}) and ends near the minimum
// of E(x) + sum_i m_i / 2 |x_i - y_i|^2, the proximal point of y, after `iterations_per_step` passes over all
// constraints. Its fixed point is a minimum of E, for every mass and step.
//   XpbdNeoHookean<float> solver(mesh, flesh, options);
//   // x: the initial guess in, the shape after the last pass out
//   XpbdNeoHookeanSummary summary = solver.minimise(targets, x);
//
// XPBD as published does not converge to this minimum: the multipliers settle within a few passes, with the forces of
// the directions that the gradients had on the way, and the shape then stays where it is (Y. Chen et al.,
// Position-based nonlinear Gauss-Seidel for quasistatic hyperelasticity, ACM TOG 43, 2024, observe it too). With the
// residual corrected in each visit, and multipliers and forces kept from step to step, one pass per step suffices. The
// momentum b is that of Y. Nesterov (1983), restarted where the forces point against the motion (B. O'Donoghue, E.
// Candes, Found. Comput. Math. 15, 2015).
#pragma once

#include "pbs/flesh/bone_springs.hpp"
#include "pbs/flesh/flesh_energy.hpp"
#include "pbs/packed/rows.hpp"

#include <memory>

namespace pbs {

// Elastic flesh as compliant constraints, and one pass of XPBD over them: the springs of the bones (bone_springs.hpp)
// and the two coupled constraints of each tet (flesh_energy.hpp). One implementation is plain, the other one packed;
// both have the same constants.
//   const XpbdFlesh flesh(mesh, energy, hold, material, time_step);
//   auto system = make_xpbd_system<float>(mesh, flesh, true, threads);
//   system->set_targets(targets);
//   system->load(positions, x);
//   system->iterate(x, true);
//
// One visit of a tet solves for the changes of its two multipliers, with inverse masses w, W = diag(w) and k = lambda
// V, mu V (Eq. 18 of M. Macklin, M. Mueller, N. Chentanez, XPBD, MIG 2016, for two constraints at once):
//   (k_a dC_a W dC_b^T + delta_ab) dlambda_b = -k_a C_a - lambda_a + k_a dC_a r,      dx = W dC^T dlambda - r.
// r = W (p - dC^T lambda) is what the tet has moved its vertices in excess of its multipliers' forces at its present
// shape (p: the forces that it has applied). XPBD neglects r, which is why it does not converge to implicit Euler; with
// r it does (Y. Chen et al., Primal extended position based dynamics for hyperelasticity, MIG 2023, keep this residual
// for all constraints at once; here each tet corrects its own). The constraints of the bones are linear, so that their
// r is zero.

// The constraints and the masses, over Young's modulus.
struct XpbdFlesh {
    // InputError: a tet without volume, or time_step not above 0.
    XpbdFlesh(const TetMesh& mesh, const FleshEnergy& energy, const BoneHold& hold, const FleshMaterial& material,
              double time_step);

    FleshMaterial material;
    std::vector<NeoHookeanTet> tets;
    HoldModes hold;
    std::vector<int> first_mode;  // of each tet, #T + 1
    // Inverse masses w_i = time_step^2 / D_i [1/m], #V. D_i is the stiffness of the energy along vertex i without its
    // volume term. The limit does not depend on the masses, and with these a small tet is no stiffer than a large one
    // in units of its masses. D_i is larger where a tet has nearly all the stiffness of several of its vertices, which
    // would oscillate. 1: no tet.
    Eigen::VectorXd w;
    double size_m = 0.0;  // diagonal of the bounding box at rest
};

// One constraint block: the springs of a tet or its pair of neo-Hookean constraints.
struct XpbdVisit {
    bool is_hold;
    int tet;
};

template <typename Scalar>
class XpbdSystem : public RowSystem<Scalar> {
public:
    // Empty rows for positions and inverse masses w. A place without a vertex has w = 1.
    Rows<Scalar> rows() const override
    {
        Rows<Scalar> rows(this->rows_);
        for (int i = 0; i < rows.size(); ++i) rows[i][3] = Scalar(1);
        for (std::size_t i = 0; i < this->place_.size(); ++i)
            rows[this->place_[i]][3] = Scalar(w_(static_cast<Eigen::Index>(i)));
        return rows;
    }
    // of the hold's modes [m]; packed: sets the origin of the rows near them
    virtual void set_targets(const Positions& targets) = 0;
    // sets all multipliers, and the forces that tets have applied, to zero
    virtual void forget() = 0;
    // Visits every constraint once. with_residual: r is corrected; otherwise it is neglected, as published.
    virtual void iterate(Rows<Scalar>& x, bool with_residual) = 0;
    virtual std::vector<XpbdVisit> visits() const = 0;  // an order in which one after the other gives the same result

protected:
    XpbdSystem(std::vector<int> place, int rows, const Eigen::VectorXd& w)
        : RowSystem<Scalar>(std::move(place), rows), w_(w)
    {
    }
    explicit XpbdSystem(const Eigen::VectorXd& w) : RowSystem<Scalar>(static_cast<int>(w.size())), w_(w) {}

    Eigen::VectorXd w_;
};

// packed: false is plain code, which is in double and exists for Scalar double alone.
template <typename Scalar>
std::unique_ptr<XpbdSystem<Scalar>> make_xpbd_system(const TetMesh& mesh, const XpbdFlesh& flesh, bool packed,
                                                     int threads);

// kept: multipliers and applied forces are kept over all steps of a frame, and the residual is corrected. of_step: they
// begin at zero in each step, and the residual is neglected, as published. reset: zero in each iteration, a common
// mistake; a negative control.
enum class XpbdMultipliers { kept, of_step, reset };

struct XpbdNeoHookeanOptions {
    int iterations = 48;          // passes over all constraints
    int iterations_per_step = 1;  // the last step may have fewer
    XpbdMultipliers multipliers = XpbdMultipliers::kept;
    bool momentum = true;  // false: b = 0
    bool packed = true;    // several elements side by side; false: plain code, one after the other, in double
    int threads = 1;
};

struct XpbdNeoHookeanSummary {
    int iterations = 0;
    int steps = 0;
    int restarts = 0;  // of the momentum
};

template <typename Scalar>
class XpbdNeoHookean {
public:
    XpbdNeoHookean(const TetMesh& mesh, const XpbdFlesh& flesh, const XpbdNeoHookeanOptions& options);

    // targets: of the hold's modes [m], #modes x 3. x [m], #V x 3.
    XpbdNeoHookeanSummary minimise(const Positions& targets, Positions& x);

private:
    double momentum();

    XpbdNeoHookeanOptions options_;
    std::unique_ptr<XpbdSystem<Scalar>> system_;
    Rows<Scalar> x_, before_, predicted_, applied_;  // of the step: x_n, y, and x - y
    double nesterov_ = 1.0;
};

// The plain implementation of XpbdSystem: one constraint after the other in double, in file order: first all springs,
// then all tets.
class PlainXpbd final : public XpbdSystem<double> {
public:
    explicit PlainXpbd(const XpbdFlesh& flesh);
    PlainXpbd(const XpbdFlesh& flesh, const std::vector<XpbdVisit>& visits);  // in another order

    void set_targets(const Positions& targets) override { targets_ = targets; }
    void forget() override;
    void iterate(Rows<double>& x, bool with_residual) override;
    std::vector<XpbdVisit> visits() const override { return visits_; }

    // The multipliers of a tet's constraints C_H and C_D [m^3], and of the modes [m^2], #modes x 3.
    const Eigen::Vector2d& multipliers_of_tet(int tet) const { return state_[tet].multipliers; }
    const Positions& multipliers_of_modes() const { return mode_multipliers_; }

private:
    struct State {
        Eigen::Vector2d multipliers = Eigen::Vector2d::Zero();
        Eigen::Matrix3d applied = Eigen::Matrix3d::Zero();  // P: the tet has applied the force P g_i to vertex i
    };
    void visit_hold(int tet, Rows<double>& x);
    void visit_tet(int tet, Rows<double>& x, bool with_residual);

    XpbdFlesh flesh_;
    std::vector<XpbdVisit> visits_;
    std::vector<Eigen::Matrix3d> weighted_;  // S = sum_i w_i g_i g_i^T of each tet
    std::vector<State> state_;
    Positions targets_, mode_multipliers_;
};

}  // namespace pbs

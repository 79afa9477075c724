// Elastic flesh in equilibrium by XPBD with the two neo-Hookean constraints of M. Macklin, M. Mueller (MIG 2021); xpbd_neo_hookean.hpp has the
// constraints and the equations of one visit. A frame is a sequence of steps of implicit Euler without inertia from frame to frame: step n
// begins at the predicted positions y = x_n + b (x_n - x_{n-1}) and ends near the minimum of E(x) + sum_i m_i / 2 |x_i - y_i|^2, the
// proximal point of y, after `iterations_per_step` passes over all constraints. Its fixed point is a minimum of E, for every mass and step.
//   XpbdNeoHookean<float> solver(mesh, flesh, options);
//   XpbdNeoHookeanSummary summary = solver.minimise(targets, x);   // x: the initial guess in, the shape after the last pass out
//
// XPBD as published does not converge to this minimum: the multipliers settle within a few passes, with the forces of the directions that
// the gradients had on the way, and the shape then stays where it is (Y. Chen et al., Position-based nonlinear Gauss-Seidel for quasistatic
// hyperelasticity, ACM TOG 43, 2024, observe it too). With the residual corrected in each visit, and multipliers and forces kept from step
// to step, one pass per step suffices. The momentum b is that of Y. Nesterov (1983), restarted where the forces point against the motion
// (B. O'Donoghue, E. Candes, Found. Comput. Math. 15, 2015).
#pragma once

namespace pbs {

// kept: multipliers and applied forces are kept over all steps of a frame, and the residual is corrected. of_step: they begin at zero in
// each step, and the residual is neglected, as published. reset: zero in each iteration, a common mistake; a negative control.
enum class XpbdMultipliers { kept, of_step, reset };

struct XpbdNeoHookeanOptions {
    int iterations = 48;          // passes over all constraints
    int iterations_per_step = 1;  // the last step may have fewer
    XpbdMultipliers multipliers = XpbdMultipliers::kept;
    bool momentum = true;  // false: b = 0
    Arithmetic arithmetic = Arithmetic::packed_f32;
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

}  // namespace pbs

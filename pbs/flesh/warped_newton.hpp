// A quasi-Newton method for elastic flesh in equilibrium whose first matrix is the warped stiffness (warped_solve.hpp),
// with sweeps of vertex block descent (vbd.hpp) before each step. The two complement each other: a step takes away what
// is spread over the body, and a sweep what a few tets resist, such as volumes that blending has crushed, at which a
// step computed from rest would overshoot.
//   WarpedNewton<float> solver(mesh, energy, factor, options);
//   // x: the initial guess in, the last iterate out
//   WarpedNewtonSummary summary = solver.minimise(centres, rotations, x);
// The energy of the result is at most that of the initial guess, except for rounding: a step after which the energy is
// higher is taken back and shortened.
#pragma once

#include "pbs/flesh/flesh_system.hpp"
#include "pbs/flesh/step_history.hpp"
#include "pbs/flesh/vbd.hpp"
#include "pbs/flesh/warped_solve.hpp"

#include <memory>
#include <vector>

namespace pbs {

struct WarpedNewtonOptions {
    int iterations = 3;  // steps; 0 leaves the initial guess
    int sweeps = 1;      // before the first step and after each one
    double omega = 1.3;  // over-relaxation of the sweeps
    int history = 5;     // pairs of steps and changes of the gradient that L-BFGS keeps
    bool packed = true;  // several elements side by side; false: plain code, one after the other, in double
    int threads = 1;
};

struct WarpedNewtonSummary {
    int iterations = 0;
    int evaluations = 0;  // of value and gradient
    int sweeps = 0;
    int taken_back = 0;  // steps after which the energy was higher
    // after the first sweeps and after each step that was kept, over Young's modulus [m^3]
    std::vector<double> energies;
};

template <typename Scalar>
class WarpedNewton {
public:
    // factor: of flesh_laplacian, for the order of its vertices. InputError: omega outside (0, 2), and those of
    // WarpedSolve.
    WarpedNewton(const TetMesh& mesh, const FleshEnergy& energy, const CholeskyFactor& factor,
                 const WarpedNewtonOptions& options);

    // centres [m], #V x 3; rotations: of the flesh around each vertex, #V; x [m], #V x 3.
    WarpedNewtonSummary minimise(const Positions& centres, const std::vector<Eigen::Matrix3d>& rotations, Positions& x);

    std::size_t entries() const { return solve_.entries(); }  // of the factor

private:
    bool is_flatter() const;
    void sweep(Rows<Scalar>& x, WarpedNewtonSummary& summary);

    WarpedNewtonOptions options_;
    std::unique_ptr<FleshSystem<Scalar>> system_;
    std::unique_ptr<VertexSweep<Scalar>> sweep_;
    WarpedSolve<Scalar> solve_;
    StepHistory<Scalar> history_;
    Rows<Scalar> x_, gradient_, direction_, next_x_, next_gradient_, swept_;
};

}  // namespace pbs

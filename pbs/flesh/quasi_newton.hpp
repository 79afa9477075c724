// The quasi-Newton method for elastic bodies of T. Liu, S. Bouaziz, L. Kavan (Quasi-Newton methods for real-time
// simulation of hyperelastic materials, ACM TOG 36(3), 2017): L-BFGS whose first matrix is a constant Laplacian
// (flesh_laplacian), factored once for all frames.
//   QuasiNewton<float> solver(mesh, energy, factor, options);
//   QuasiNewtonSummary summary = solver.minimise(centres, x);   // x: the initial guess in, the minimum out
#pragma once

#include "pbs/flesh/flesh_contact.hpp"
#include "pbs/flesh/flesh_system.hpp"
#include "pbs/flesh/step_history.hpp"

#include <optional>

namespace pbs {

struct QuasiNewtonOptions {
    int iterations = 24;  // at most
    int history = 5;      // pairs of steps and changes of the gradient that L-BFGS keeps
    double stop_gradient =
        0.0;  // stop where the norm of H^-1 g is below this share of its first value, or is rounding; 0: never
    bool packed = true;  // several elements side by side; false: plain code, one after the other, in double
    int threads = 1;
    bool contact = false;  // a penalty on skin in flesh of another part (FleshContact)
};

struct QuasiNewtonSummary {
    int iterations = 0;
    int evaluations = 0;        // of value and gradient
    int solves = 0;             // with the factor, for three right-hand sides
    bool converged = false;     // stop_gradient was reached, or no step lowers the energy any more in this arithmetic
    double energy = 0.0;        // over Young's modulus, without the constant [m^3]
    std::vector<double> steps;  // norm of H^-1 g at the beginning of each iteration [m]
};

template <typename Scalar>
class QuasiNewton {
public:
    QuasiNewton(const TetMesh& mesh, const FleshEnergy& energy, const CholeskyFactor& factor,
                const QuasiNewtonOptions& options);

    // x [m], #V x 3.
    QuasiNewtonSummary minimise(const Positions& centres, Positions& x);

private:
    double value_and_gradient(const Rows<Scalar>& x, Rows<Scalar>& gradient);
    bool seek_contacts(QuasiNewtonSummary& summary);
    double set_direction();
    bool search(double slope, QuasiNewtonSummary& summary);

    QuasiNewtonOptions options_;
    std::unique_ptr<FleshSystem<Scalar>> system_;
    std::optional<FleshContact<Scalar>> contact_;
    Rows<Scalar> x_, gradient_, direction_, next_x_, next_gradient_;
    StepHistory<Scalar> history_;
};

}  // namespace pbs

// Vertex block descent for elastic bodies in equilibrium (A. H. Chen, Z. Liu, Y. Yang, C. Yuksel, Vertex block descent, ACM TOG 43(4),
// 2024), without inertia: nonlinear Gauss-Seidel over vertices (Y. Chen et al., Position-based nonlinear Gauss-Seidel for quasistatic
// hyperelasticity, 2023). The energy along one vertex is exactly quadratic here (vbd.hpp), so that one step of Newton's method is
// its minimum and needs neither a projection of its matrix nor a line search.
//   VertexBlockDescent<float> solver(mesh, energy, options);
//   VertexBlockSummary summary = solver.minimise(centres, x);   // x: the initial guess in, the last iterate out
#pragma once

#include "pbs/flesh/vbd.hpp"

namespace pbs {

// over_relaxation: each vertex moves by omega times the way to its minimum, which decreases the energy for 0 < omega < 2. The energy has
// several minima; from a poor initial guess, a large omega may end in another one than a small omega.
// chebyshev: sweeps with omega = 1, and after each one x_{k+1} = omega_{k+1} (x - x_{k-1}) + x_{k-1} with chebyshev_weights. The energy may
// increase, and the method may diverge where rho is above the rate at which the sweeps converge.
enum class Acceleration { over_relaxation, chebyshev };

// The default omega has the smallest worst error after 48 and after 64 sweeps on two poses of the limb and two of the human, of 1.8, 1.85,
// 1.88, 1.9, 1.92 and 1.95. On these and on eight other poses, 64 sweeps end within 0.5 % of the minimum: root mean square difference at
// the joints over the mean distance to the bones (nu = 0.45, smooth initial guess).
struct VertexBlockOptions {
    int iterations = 64;  // sweeps over all vertices
    Acceleration acceleration = Acceleration::over_relaxation;
    double omega = 1.88;
    double rho = 0.95;  // the estimated spectral radius of a sweep, from 0 inclusive to 1 exclusive
    Arithmetic arithmetic = Arithmetic::packed_f32;
    int threads = 1;
};

struct VertexBlockSummary {
    int iterations = 0;
    bool is_finite = true;  // false: a position is infinite or NaN
};

// omega_1 ... omega_count: 1, 2 / (2 - rho^2), then omega_{k+1} = 4 / (4 - rho^2 omega_k).
std::vector<double> chebyshev_weights(double rho, int count);

template <typename Scalar>
class VertexBlockDescent {
public:
    // InputError: omega outside (0, 2), or rho outside [0, 1).
    VertexBlockDescent(const TetMesh& mesh, const FleshEnergy& energy, const VertexBlockOptions& options);

    // x [m], #V x 3. A vertex without tets stays.
    VertexBlockSummary minimise(const Positions& centres, Positions& x);
    std::size_t bytes_an_iteration() const { return sweep_->bytes(); }

private:
    void sweep_over_relaxed();
    void sweep_with_chebyshev();

    VertexBlockOptions options_;
    std::vector<double> weights_;  // of Chebyshev, #iterations; empty: over-relaxation
    std::unique_ptr<VertexSweep<Scalar>> sweep_;
    Rows<Scalar> x_, before_, before_that_;
};

}  // namespace pbs

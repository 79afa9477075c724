// Vertex block descent for elastic bodies in equilibrium (A. H. Chen, Z. Liu, Y. Yang, C. Yuksel, Vertex block descent,
// ACM TOG 43(4), 2024), without inertia: nonlinear Gauss-Seidel over vertices (Y. Chen et al., Position-based nonlinear
// Gauss-Seidel for quasistatic hyperelasticity, 2023). The energy along one vertex is exactly quadratic here
// (VertexStar), so that one step of Newton's method is its minimum and needs neither a projection of its matrix nor a
// line search.
//   VertexBlockDescent<float> solver(mesh, energy, options);
//   VertexBlockSummary summary = solver.minimise(centres, x);   // x: the initial guess in, the last iterate out
#pragma once

#include "pbs/flesh/flesh_contact.hpp"
#include "pbs/flesh/flesh_energy.hpp"
#include "pbs/flesh/flesh_kernels.hpp"
#include "pbs/packed/parallel.hpp"
#include "pbs/packed/rows.hpp"
#include "pbs/packed/vertex_order.hpp"

#include <array>
#include <memory>
#include <optional>
#include <vector>

namespace pbs {

// The spring that holds a vertex, relative to the origin of the rows.
struct VertexHold {
    Vec3 centre;                 // c_i [m]
    double stiffness, diagonal;  // a_i, and that of VertexStar [m]
};

// Sweeps of vertex block descent on rows of numbers. One implementation is plain, the other one packed; both move the
// vertices by the same colours (vertex_colours), one colour after the other.
//   auto sweep = make_vertex_sweep<float>(mesh, energy, true, threads);
//   sweep->set_centres(centres);
//   sweep->load(positions, x);
//   sweep->move(1.88, x);   // x_i -= omega H_i^-1 g_i for each vertex, each with the latest positions of the others
template <typename Scalar>
class VertexSweep : public RowSystem<Scalar> {
public:
    // c_i [m], #V x 3; packed: their mean becomes the origin of the rows
    virtual void set_centres(const Positions& centres) = 0;
    virtual void move(double omega, Rows<Scalar>& x) = 0;
    virtual VertexHold hold(int vertex) const = 0;
    // until set_centres; the diagonal, until it is set again
    virtual void set_hold(int vertex, const VertexHold& hold) = 0;
    // x = before + omega (x - before)
    virtual void extrapolate(double omega, const Rows<Scalar>& before, Rows<Scalar>& x) const = 0;

protected:
    using RowSystem<Scalar>::RowSystem;
};

// packed: false is plain code, which is in double and exists for Scalar double alone.
template <typename Scalar>
std::unique_ptr<VertexSweep<Scalar>> make_vertex_sweep(const TetMesh& mesh, const FleshEnergy& energy, bool packed,
                                                       int threads);

// over_relaxation: each vertex moves by omega times the way to its minimum, which decreases the energy for 0 < omega
// < 2. The energy has several minima; from a poor initial guess, a large omega may end in another one than a small
// omega. chebyshev: sweeps with omega = 1, and after each one x_{k+1} = omega_{k+1} (x - x_{k-1}) + x_{k-1} with
// chebyshev_weights. The energy may increase, and the method may diverge where rho is above the rate at which the
// sweeps converge.
enum class Acceleration { over_relaxation, chebyshev };

// The default omega has the smallest worst error after 48 and after 64 sweeps on two poses of the limb and two of the
// human, of 1.8, 1.85, 1.88, 1.9, 1.92 and 1.95. On these and on eight other poses, 64 sweeps end within 0.5 % of the
// minimum: root mean square difference at the joints over the mean distance to the bones (nu = 0.45, smooth initial
// guess).
struct VertexBlockOptions {
    int iterations = 64;  // sweeps over all vertices
    Acceleration acceleration = Acceleration::over_relaxation;
    double omega = 1.88;
    double rho = 0.95;   // the estimated spectral radius of a sweep, from 0 inclusive to 1 exclusive
    bool packed = true;  // several elements side by side; false: plain code, one after the other, in double
    int threads = 1;
    bool contact = false;  // a penalty on skin in flesh of another part (FleshContact)
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

private:
    void sweep(int iteration, double omega);

    VertexBlockOptions options_;
    std::vector<double> weights_;  // of Chebyshev, #iterations; empty: over-relaxation
    std::unique_ptr<VertexSweep<Scalar>> sweep_;
    std::optional<FleshContact<Scalar>> contact_;
    Rows<Scalar> x_, before_, before_that_;
};

// The energy of the flesh (flesh_energy.hpp) along one vertex. It is exactly quadratic: moving x_i by s adds g_i . s +
// s . H_i s / 2, with
//   g_i = a_i (x_i - c_i) + sum_tets [ sum_j w_ij (x_i - x_j) + kappa (6 V - d) n_i ],
//   H_i = (a_i + sum_tets sum_j w_ij) I + sum_tets kappa n_i n_i^T,
// where n_i, the gradient of 6 V in x_i, is twice the area of the opposite face times its normal, and does not depend
// on x_i.
//   const std::vector<VertexStar> stars = vertex_stars(energy);
//   x.row(i) -= block_step(vertex_block(stars[i], i, x, centres)).transpose();   // the minimum along vertex i

// A tet as one of its vertices meets it. The others are in the order in which n_i = (x_1 - x_0) x (x_2 - x_0).
struct IncidentTet {
    std::array<int, 3> other;
    std::array<double, 3> w;  // of the edges to them [m]
    double kappa;             // [1/m^3]
    double d;                 // [m^3]
};

// The tets around a vertex, in the order of the mesh. diagonal: a_i + sum_tets sum_j w_ij [m], which is the sum of mu
// V0 |grad N_i|^2 and k_s beta_i^2, and therefore above zero where there is a tet.
struct VertexStar {
    std::vector<IncidentTet> tets;
    double hold = 0.0;      // a_i [m]
    double diagonal = 0.0;  // [m]
};
std::vector<VertexStar> vertex_stars(const FleshEnergy& energy);  // #V

struct VertexBlock {
    Vec3 gradient;            // g_i [m^2]
    Eigen::Matrix3d hessian;  // H_i [m]
    double diagonal;          // the smallest eigenvalue that H_i can have [m]
};
VertexBlock vertex_block(const VertexStar& star, int vertex, const Positions& x, const Positions& centres);

// H_i^-1 g_i [m] by H = L D L^T; zero where the diagonal is not above zero, as at a vertex without tets. A pivot is a
// Schur complement of diagonal * I + sum kappa n n^T and at least the diagonal; rounding may not decrease it further.
Vec3 block_step(const VertexBlock& block);

}  // namespace pbs

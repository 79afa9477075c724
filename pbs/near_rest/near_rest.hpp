// The paper's volume constraints, one per tet, linearised at rest: how many motions they leave, and how a body that
// obeys them yields to a load. On linear tets they ask exactly what incompressibility asks of the displacements (div u
// = 0 in each), so they lock as P1 does as nu goes to 1/2.
//   const VolumeConstraints volumes(mesh, held);
//   volumes.dofs() - volumes.rank();           // independent motions that change no tet's volume
//   volumes.equilibrium(load_n, shear_pa);     // of an elastic body that keeps every volume
#pragma once

#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/solver/constraint_set.hpp"

#include <Eigen/SparseCore>

#include <array>
#include <vector>

namespace pbs {

class VolumeConstraints {
public:
    VolumeConstraints(const TetMesh& mesh, const std::vector<bool>& held);  // held: #V, the vertices that do not move

    int constraints() const { return static_cast<int>(gradients_.rows()); }
    int dofs() const { return static_cast<int>(gradients_.cols()); }  // of the vertices that are not held
    int rank() const;                                                 // by QR; seconds for some thousand tets

    // Displacements [m], #V x 3, under a load [N], #V x 3, of linear tets of this shear modulus [Pa] that keep every
    // volume, by the method of multipliers. At least three vertices are held.
    Positions equilibrium(const Positions& load_n, double shear_pa) const;

private:
    Eigen::SparseMatrix<double> shear_stiffness() const;  // of 1 Pa: the integral of 2 eps : eps

    TetMesh mesh_;
    std::vector<int> free_, place_;  // the vertices that are not held; of each vertex, its place among them, -1: held
    // #T x dofs, row t: grad C_t / sqrt(V0_t) [m^(1/2)], so that gradients^T gradients is the integral of div phi_i div
    // phi_j.
    Eigen::SparseMatrix<double> gradients_;
};

// Near rest the iterations of a step, lines (10)-(14) of Algorithm 1, are a linear map S of displacements.
// This is S, for the position based solver and for XPBD. One projection takes  C = sum g_i . u_i  and computes
//   dlambda = -share (C + alpha / dt^2 lambda) / (sum w |g|^2 + alpha / dt^2),   u_i += w_i g_i dlambda
// The position based solver has share = k and alpha = 0; XPBD has share = 1 and its compliance alpha. lambda belongs to
// one step.
class StepNearRest {
public:
    // rest, bind_point: vertices and their material points [m], #V x 3; no bind_point where nothing is bound.
    // forgets_multipliers: lambda is zero in every iteration.
    StepNearRest(const Positions& rest, const Positions& bind_point, int iterations, double step_s,
                 bool forgets_multipliers = false);

    // Appends the projection of a bind, stretch or volume constraint. inverse_mass: #V.
    template <typename Constraint>
    void add(const Constraint& constraint, double share, double compliance, const std::vector<double>& inverse_mass);

    void apply(Positions& displacement);  // #V x 3, in place: the iterations of one step
    double step_s() const { return step_s_; }

private:
    struct Projection {
        int vertices = 0;
        int vertex[4];
        double compliance_per_dt2 = 0.0, share = 1.0, denominator = 0.0;
        Vec3 gradient[4], moved[4];  // of the constraint at rest; w times it
        double multiplier = 0.0;
    };
    template <typename Constraint, std::size_t count>
    void add_gradients(const Constraint& constraint, const std::array<Vec3, count>& gradients, double share,
                       double compliance, const std::vector<double>& inverse_mass);

    Positions rest_, bind_point_;
    int iterations_;
    double step_s_;
    bool forgets_;
    std::vector<Projection> projections_;
};

// Where a body comes to rest under a small constant acceleration a. With lines (7)-(8) and (16) of Algorithm 1 a step
// is x <- S (2 x - x_before + a dt^2), which rests at x = (I - S)^-1 S a dt^2 whatever the damping. GMRES finds that
// state, whereas time stepping would swing for thousands of steps.
//   const RestingState state = settle(mesh, held, options, {0.0, 0.0, -9.81});   // the paper's solver
//   positions = mesh.rest + dt_s * dt_s * state.displacement;
struct RestingState {
    Positions displacement;  // [m], #V x 3; zero where nothing moves
    bool converged = false;
    double residual = 0.0;  // |x - S (x + a dt^2)| / |S a dt^2|
    int steps = 0;          // applications of S
};

struct KrylovSpace {
    int vectors = 400, most_iterations = 800;
};

// moves: #V, which vertices keep their displacement from one step to the next and are accelerated.
RestingState rest_of(StepNearRest& step, const std::vector<bool>& moves, const Vec3& acceleration_m_s2,
                     const KrylovSpace& space = {});

// The paper's solver with a time step of 1 s; a displacement scales with dt^2. Bind constraints are left out, as they
// would hold the axis. The result depends on the iterations, stiffnesses and masses in the options; InputError where
// they constrain regions. held: #V, vertices that do not move.
RestingState settle(const TetMesh& mesh, const std::vector<bool>& held, const PbsOptions& options,
                    const Vec3& acceleration_m_s2);

}  // namespace pbs

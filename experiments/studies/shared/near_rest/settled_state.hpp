// Where the paper's solver comes to rest under a small constant acceleration.
//   const SettledState state = settle(mesh, held, options, {0.0, 0.0, -9.81});
//   positions = mesh.rest + dt_s * dt_s * state.displacement_over_dt2;
// Near rest the iterations of a step, lines (10)-(14) of Algorithm 1, are a linear map S of displacements: each projection takes away the
// share k of what its constraint feels of them. With lines (7)-(8) and (16) a step is x <- S (2 x - x_before + a dt^2), whatever the time
// step, which rests at x = dt^2 (I - S)^-1 S a: found by GMRES, where stepping would swing for thousands of steps.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/solver/constraint_set.hpp"

#include <vector>

namespace experiments {

// S, from the solver's own constraints in their own order, linearised at rest. Bind constraints are left out: they would hold the axis.
class IterationsNearRest {
public:
    // held: #V. Of the options, iterations, stiffnesses and masses count.
    IterationsNearRest(const pbs::TetMesh& mesh, const std::vector<bool>& held, const pbs::PbsOptions& options);

    void apply(pbs::Positions& displacement) const;  // #V x 3, in place; held vertices are not moved

private:
    struct Projection {
        int vertices = 0;
        int vertex[4];
        pbs::Vec3 gradient[4];    // of the constraint at rest
        pbs::Vec3 correction[4];  // of each vertex, for a constraint value of 1
    };
    template <typename Constraint, std::size_t count>
    void add(const Constraint& constraint, const std::array<pbs::Vec3, count>& gradients, const std::vector<double>& inverse_mass);

    int iterations_;
    std::vector<Projection> projections_;
};

struct SettledState {
    pbs::Positions displacement_over_dt2;  // [m/s^2], #V x 3; times dt^2 the displacement [m]; zero at held vertices
    bool converged = false;
    double residual = 0.0;  // |x - S (x + a dt^2)| / |S a dt^2|
    int steps = 0;          // applications of S
};
SettledState settle(const pbs::TetMesh& mesh, const std::vector<bool>& held, const pbs::PbsOptions& options,
                    const pbs::Vec3& acceleration_m_s2);

}  // namespace experiments

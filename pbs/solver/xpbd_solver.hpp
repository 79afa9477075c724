// Extended position based dynamics (M. Macklin, M. Mueller, N. Chentanez, MIG 2016) with the paper's constraints and an elastic material.
// The multiplier of each constraint is kept through all iterations of a step, so that the stiffness does not depend on their number.
//   XpbdSolver solver(mesh, bind_distance, jiggle_zone, options);
//   solver.advance(lbs_positions, bind_points, dt);
//
// The compliances follow from the material by the Cauchy solid. Springs on edges have the stiffness 15 mu V_e / l^2, where V_e is a sixth
// of the rest volume of the tets around the edge. They form an isotropic solid with Lame's constants mu, mu (Poisson's ratio 1/4), as far
// as edges point in all directions equally. A volume constraint per tet with the bulk modulus K - 5/3 mu adds what is missing. Bind
// constraints are rigid. As in PBS, particles outside the jiggling zone begin every step at their LBS position without velocity; their mass
// holds them to their position at the beginning of a substep. With many substeps of one iteration (M. Macklin et al., Small steps in
// physics simulation, SCA 2019) the multipliers begin at zero in each substep.
//
// The projections run in the order and the precision of the options: `plain` one after the other, `ordered` and `grouped` sixteen at once
// in the sequence of PBS, which settles on another limit. In float, they are relative to the mean position of the step.
#pragma once

#include "pbs/solver/step_summary.hpp"

#include <memory>
#include <vector>

namespace pbs {

class XpbdSolver {
public:
    // bind_distance: d_i [m], #V; empty: no bind constraints. jiggle_zone: #V, or empty. held: #V, or empty: infinite mass.
    XpbdSolver(const TetMesh& mesh, const Eigen::VectorXd& bind_distance, const std::vector<bool>& jiggle_zone, const XpbdOptions& options,
               const std::vector<bool>& held = {});

    StepSummary advance(const Positions& lbs_positions, const Positions& bind_points, double dt_s);
    const Positions& positions() const { return x_; }  // [m], #V x 3

    const XpbdConstraints& constraints() const { return constraints_; }

private:
    void predict(double dt_s);
    void update_velocities(double dt_s);
    StepSummary summary(double seconds) const;

    XpbdOptions options_;
    std::vector<bool> integrated_;
    bool integrates_ = false;  // any particle
    XpbdConstraints constraints_;
    std::unique_ptr<XpbdProjection> projection_;
    Positions x_, before_, v_;  // [m], [m], [m/s], #V x 3
    bool started_ = false;
};

}  // namespace pbs

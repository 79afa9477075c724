// Extended position based dynamics (M. Macklin, M. Mueller, N. Chentanez, MIG 2016) with the paper's constraints and an
// elastic material. The multiplier of each constraint is kept through all iterations of a step, so that the stiffness
// does not depend on their number.
//   XpbdSolver solver(mesh, bind_distance, jiggle_zone, options);
//   solver.advance(lbs_positions, bind_points, dt);
//
// The compliances follow from the material by the Cauchy solid. Springs on edges have the stiffness 15 mu V_e / l^2,
// where V_e is a sixth of the rest volume of the tets around the edge. They form an isotropic solid with Lame's
// constants mu, mu (Poisson's ratio 1/4), as far as edges point in all directions equally. A volume constraint per tet
// with the bulk modulus K - 5/3 mu adds what is missing. Bind constraints are rigid. As in PBS, particles outside the
// jiggling zone begin every step at their LBS position without velocity; their mass holds them to their position at the
// beginning of a substep. With many substeps of one iteration (M. Macklin et al., Small steps in physics simulation,
// SCA 2019) the multipliers begin at zero in each substep.
//
// The projections run in the order and the precision of the options: `plain` one after the other, `ordered`
// sixteen at once in the sequence of PBS, which settles on another limit. In float, they are relative to the
// mean position of the step.
#pragma once

#include "pbs/constraints/bind.hpp"
#include "pbs/constraints/stretch.hpp"
#include "pbs/constraints/volume.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/solver/options.hpp"
#include "pbs/solver/step_summary.hpp"

#include <memory>
#include <vector>

namespace pbs {

template <typename Constraint>
struct Compliant {
    Constraint constraint;    // its stiffness is 1 and not used
    double compliance = 0.0;  // alpha: of a length [m/N], of a volume [m^5/N]
};

// In the order of their projection.
struct XpbdConstraints {
    std::vector<Compliant<BindConstraint<double>>> bind;        // by vertex, compliance zero
    std::vector<Compliant<StretchConstraint<double>>> stretch;  // by edges
    std::vector<Compliant<VolumeConstraint<double>>> volume;    // by tets; none where Poisson's ratio is 1/4
    std::vector<double> inverse_mass;                           // [1/kg], #V; zero: held
};

// bind_distance: d_i [m], #V; empty: no bind constraints. held: #V, or empty. InputError for Poisson's ratios outside
// [1/4, 1/2).
XpbdConstraints make_xpbd_constraints(const TetMesh& mesh, const Eigen::VectorXd& bind_distance,
                                      const XpbdOptions& options, const std::vector<bool>& held);

// The projections of extended position based dynamics in a chosen order, as projection.hpp has those of Algorithm 1:
// each class once, on positions in a layout of its own, with the multiplier of each constraint.
//   const auto projection = make_xpbd_projection(constraints, mesh.tets, options);
//   projection->load(p, q, origin);
//   projection->begin_substep(dt_s);
//   projection->project_bind_constraints(); ..stretch.. ..volume..
//   projection->store(origin, p);
class XpbdProjection {
public:
    virtual ~XpbdProjection() = default;

    // p: positions, q: posed bind points [m], #V x 3; inside, positions are relative to origin [m].
    virtual void load(const Positions& p, const Positions& q, const Vec3& origin) = 0;
    // The substep has this length; all multipliers become zero.
    void begin_substep(double dt_s)
    {
        dt2_s2_ = dt_s * dt_s;
        forget_multipliers();
    }
    virtual void forget_multipliers() = 0;        // they become zero
    virtual void project_bind_constraints() = 0;  // all of the class once
    virtual void project_stretch_constraints() = 0;
    virtual void project_volume_constraints() = 0;
    // Positions back in p [m], #V x 3; origin as it was given to load.
    virtual void store(const Vec3& origin, Positions& p) const = 0;

protected:
    double dt2_s2_ = 0.0;  // the square of the substep [s^2]
};

// The order and the precision that the options name. tets: those of the mesh.
std::unique_ptr<XpbdProjection> make_xpbd_projection(const XpbdConstraints& constraints, const Tets& tets,
                                                     const XpbdOptions& options);

class XpbdSolver {
public:
    // bind_distance: d_i [m], #V; empty: no bind constraints. jiggle_zone: #V, or empty. held: #V, or empty: infinite
    // mass.
    XpbdSolver(const TetMesh& mesh, const Eigen::VectorXd& bind_distance, const std::vector<bool>& jiggle_zone,
               const XpbdOptions& options, const std::vector<bool>& held = {});

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

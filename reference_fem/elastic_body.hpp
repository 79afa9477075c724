// The reference solver at large rotations: any of the laws on the character's own tets, which the skeleton holds as in
// LinearElasticity, quasi-static or in time.
//   ElasticBody body(mesh, options, attachment);
//   const LoadPathSummary path = body.solve(targets_at, gravity_m_s2);        // equilibrium, from the last one
//   const LoadPathSummary step = body.advance(targets_at, gravity_m_s2, dt);  // or one time step
//   body.positions();
// A state that was not reached is a reported outcome: the positions are then those of the last converged state, and
// moved_in_last_iterate() gives those in which Newton's method ended.
#pragma once

#include "reference_fem/attachment.hpp"
#include "reference_fem/contact/contact_potential.hpp"
#include "reference_fem/laws/constitutive_law.hpp"
#include "reference_fem/newton/newton.hpp"
#include "reference_fem/options.hpp"
#include "reference_fem/potentials/potentials.hpp"

#include <functional>
#include <memory>

namespace reference_fem {

// Out of bounds: pbs::InputError from ElasticBody's constructor.
struct ElasticOptions {
    Model model = Model::stable_neo_hookean;  // the law; `linear` keeps one factor for all quasi-static solves
    int element_order = 2;                    // 1, 2
    Formulation formulation =
        Formulation::displacement;  // not taylor_hood; mean_dilatation for laws with a volume term
    double young_pa = 1.0e5;        // Young's modulus E > 0
    double poisson = 0.45;          // Poisson's ratio, -1 < nu < 0.5
    double density_kg_m3 = 1000.0;  // >= 0; where there is inertia > 0
    Dynamics dynamics =
        Dynamics::quasi_static;         // quasi_static: solve() and solve_at_once(); else solve() and advance()
    double rayleigh_mass_1_s = 0.0;     // damping C = rayleigh_mass M + rayleigh_stiffness K(rest)
    double rayleigh_stiffness_s = 0.0;  // both finite, >= 0
    double spectral_radius = 0.8;       // of generalised-alpha at infinite frequency, 0 to 1
    // of the surface with itself; range 0: none. Not with generalized_alpha
    ContactOptions contact = {};
    LinearSolver solver = LinearSolver::cholmod;  // of the systems in Newton
    NewtonOptions newton = {};                    // of each attempt on the path
    LoadPathOptions path = {};                    // how solve() and advance() divide the way
};

// The positions that the skeleton prescribes at a fraction of the way from the last solved state (0) to this one (1).
struct Targets {
    pbs::Positions springs;      // [m], #S x 3
    pbs::Positions vertices;     // [m], #V x 3, read at the vertices of prescribed tets only
    pbs::Positions bind_points;  // [m], #V x 3, where the attachment binds; else empty
    // [m], #V x 3, or empty. The initial guess of solve() is the last state plus the change of the guide since
    pbs::Positions guide = {};
    // then. The solution does not depend on it
};
// may be called twice for a fraction, and after a failure for a lower one
using TargetsAt = std::function<Targets(double fraction)>;

// Keeps what it needs: mesh, options and attachment may go.
class ElasticBody {
public:
    // pbs::InputError where an option, the mesh or the attachment is out of bounds, or a connected part of the mesh is
    // not held.
    ElasticBody(const pbs::TetMesh& mesh, const ElasticOptions& options, const Attachment& attachment);
    ~ElasticBody();

    // Equilibrium, along a path on which targets and gravity go from the last state's to these. pbs::InputError for
    // gravity that is not finite and targets of the wrong number.
    LoadPathSummary solve(const TargetsAt& targets_at, const pbs::Vec3& gravity_m_s2);
    // As solve(), but in a single attempt from the last state or start_from(): for an initial guess that already has
    // these targets.
    LoadPathSummary solve_here(const Targets& targets, const pbs::Vec3& gravity_m_s2);
    // One step of options.dynamics from rest or the last state, whose targets are those at fraction 0; in between,
    // targets and gravity move linearly in time. A step whose Newton fails is taken in halves, which ask for targets at
    // their own fractions; where fraction 1 is not reached, nothing of the step is kept. After solve() the body is at
    // rest. The frame of reference is taken to be inertial: a skeleton whose root moves is to be given as it is in the
    // world. Gravity acts in full from the first step on. pbs::InputError where quasi-static, for a step that is not
    // finite and > 0, and as solve().
    LoadPathSummary advance(const TargetsAt& targets_at, const pbs::Vec3& gravity_m_s2, double time_step_s);

    // Sets an initial guess for Newton's method other than the last state [m], #V x 3, with mid-edge nodes halfway; or
    // #nodes x 3. It becomes the current state. The solution does not depend on it, only the number of iterations does.
    void start_from(const pbs::Positions& vertices);
    void start_from_nodes(const pbs::Positions& nodes);

    // Asked before each linear solve: once it is true, Newton's method is given up and the state that was asked for is
    // not reached.
    void give_up_when(std::function<bool()> is_over);

    // Newton alone for these targets, from the last state or start_from(), however broken: no load path, nothing taken
    // back. positions() are then the last iterate, converged or not. pbs::InputError unless quasi-static, and as
    // solve(). With contact, an initial guess that intersects itself ends with the outcome intersects_itself: the
    // barrier would keep it as it is. This holds for solve_here(), too.
    NewtonSummary solve_at_once(const Targets& targets, const pbs::Vec3& gravity_m_s2);

    const pbs::Positions& positions() const;      // deformed vertices [m], #V x 3
    const pbs::Positions& nodes_at_rest() const;  // [m], #nodes x 3: vertices, then the middles of edges
    // Where places in the tets are now [m], #P x 3, interpolated by the elements and extrapolated outside; not a number
    // for a place without a tet, as places_of() gives it to a point outside the flesh.
    pbs::Positions moved(const std::vector<pbs::Location>& places) const;
    std::vector<pbs::Location> places_of(const pbs::Positions& points_at_rest) const;  // [m], #P x 3
    // As moved() and jacobians(), in the state in which Newton's method ended last, converged or not. At rest before
    // the first solve.
    pbs::Positions moved_in_last_iterate(const std::vector<pbs::Location>& places) const;
    Jacobians jacobians_of_last_iterate() const;
    // of every node of the space [m], #dofs: vertices, then the middles of edges
    const Eigen::VectorXd& displacement() const;
    pbs::Positions spring_points_deformed() const;  // where the tied points went [m], #S x 3
    double strain_energy_j() const;                 // of the flesh alone
    double potential_energy_j() const;              // with springs, gravity and contact, for the last targets
    double kinetic_energy_j() const;                // 0 where quasi-static
    Jacobians jacobians() const;                    // det F at the quadrature points of the elements
    ContactState contact() const;                   // no pair where there is no contact
    std::vector<PressedPair> pressed() const;       // the pairs of a node and a triangle among them
    std::vector<bool> prescribed_vertices() const;  // #V
    const SetupSummary& setup() const;              // solver and factor from the first solve on

private:
    class Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace reference_fem

// Steps a sum of potentials through time: M u'' + C u' + grad Pi(u) = 0, some degrees of freedom prescribed, by either
// scheme below. Consistent mass; Rayleigh's damping C = a M + b K, K the flesh's stiffness at rest.
//   TimeStepper stepper(space, prescribed, flesh, {.density_kg_m3 = 1000.0}, newton);
//   stepper.start(u0, v0);  // the acceleration follows from the balance of forces
//   const LoadPathSummary step = stepper.advance({&flesh, &springs}, data, step_s, displacement, {}, {});
//   stepper.motion();
// C is that of the rest pose: once a body has turned, b K resists rigid rotation too; a M resists all motion, rigid or
// not.
#pragma once

#include "reference_fem/assembly.hpp"
#include "reference_fem/newton/newton.hpp"
#include "reference_fem/potentials/potentials.hpp"

#include <Eigen/Core>

#include <vector>

namespace reference_fem {

// The consistent mass of a space as an operator on displacements: the same scalar matrix for each component.
// Keeps its own matrix: the space may go.
class ConsistentMass {
public:
    // of a homogeneous body; the sign of the density is not checked
    ConsistentMass(const SimplexSpace& space, double density_kg_m3);

    Eigen::VectorXd times(const Eigen::VectorXd& values) const;  // M x, #dofs
    void add_to(NodalMatrix& matrix, double factor) const;       // + factor M
    SparseMatrix matrix() const;                                 // M, #dofs x #dofs, [kg]

private:
    SparseMatrix of_nodes_;  // [kg], #nodes x #nodes
};

// Inertia as a potential of one time step: c / 2 |w - w~|_M^2, whose gradient is M a. The mass-proportional part of
// Rayleigh's damping is another one, with its own c and centre. Call set() before anything else.
class InertiaPotential : public Potential {
public:
    explicit InertiaPotential(const ConsistentMass& mass) : mass_(mass) {}  // which outlives the potential

    // c [1/s^2], w~ [m], #dofs.
    void set(double coefficient, Eigen::VectorXd centre)
    {
        coefficient_ = coefficient;
        centre_ = std::move(centre);
    }

    double value(const Eigen::VectorXd& displacement) const override
    {
        const Eigen::VectorXd offset = displacement - centre_;
        return coefficient_ / 2.0 * offset.dot(mass_.times(offset));
    }
    void add_gradient(const Eigen::VectorXd& displacement, Eigen::VectorXd& gradient) const override
    {
        value_and_add_gradient(displacement, gradient);
    }
    double value_and_add_gradient(const Eigen::VectorXd& displacement, Eigen::VectorXd& gradient) const override
    {
        const Eigen::VectorXd offset = displacement - centre_, force = coefficient_ * mass_.times(offset);
        gradient += force;
        return force.dot(offset) / 2.0;
    }
    void add_hessian(const Eigen::VectorXd&, Definiteness, NodalMatrix& hessian) const override
    {
        mass_.add_to(hessian, coefficient_);
    }
    bool is_quadratic() const override { return true; }

private:
    const ConsistentMass& mass_;
    double coefficient_ = 0.0;
    Eigen::VectorXd centre_;
};

// Implicit one-step schemes for M u'' + C u' + grad Pi(u) = 0 as incremental potentials: generalised-alpha (J. Chung,
// G. Hulbert, J. Appl. Mech. 60(2), 1993) and Newmark's average acceleration (N. Newmark, J. Eng. Mech. Div. ASCE 85,
// 1959), its case alpha_m = alpha_f = 0. With x_(n+1-alpha) = (1 - alpha) x_(n+1) + alpha x_n and the step h:
//   M a_(n+1-alpha_m) + C v_(n+1-alpha_f) + grad Pi(u_(n+1-alpha_f)) = 0   balance, data at t_(n+1-alpha_f)   (a)
//   u_(n+1) = u_n + h v_n + h^2 ((1/2 - beta) a_n + beta a_(n+1))   (b)
//   v_(n+1) = v_n + h ((1 - gamma) a_n + gamma a_(n+1))   (c)
// The unknown is w = u_(n+1-alpha_f). Eliminating a_(n+1) by (b) and v_(n+1) by (c) leaves both rates affine in w:
//   a_(n+1-alpha_m) = c_m (w - w~),  c_m = (1 - alpha_m) / ((1 - alpha_f) beta h^2)   (d)
//   v_(n+1-alpha_f) = c_c (w - w^),  c_c = gamma / (beta h)   (e)
//   w~ = u_n + (1 - alpha_f) (h v_n + (1/2 - beta / (1 - alpha_m)) h^2 a_n)   (f)
//   w^ = u_n + (1 - alpha_f - beta / gamma) h v_n + (1 - alpha_f) (1/2 - beta / gamma) h^2 a_n   (g)
// so that (a) says that w is a stationary point of  c_m / 2 |w - w~|_M^2 + c_c / 2 |w - w^|_C^2 + Pi(w).
// grad Pi is taken at the mean displacement, not averaged over both ends: where a body turns by theta in a step, w lies
// on the chord and generalised-alpha sees a strain of alpha_f (1 - alpha_f) theta^2 / 2, of second order in h. Newmark
// (w = u_(n+1)) sees none. a_n of generalised-alpha is the acceleration at t_n + (alpha_m - alpha_f) h (S. Erlicher, L.
// Bonaventura, O. Bursi, Comput. Mech. 28, 2002): where the next step has another length it is moved to that one's
// place, so that the order stays.
// The parameters of Eqs. (a) to (c), without unit.
struct TimeScheme {
    double alpha_m = 0.0, alpha_f = 0.0, beta = 0.25, gamma = 0.5;  // the defaults are Newmark's average acceleration
};

TimeScheme newmark();  // second order, unconditionally stable, without dissipation in linear problems

// Second order, unconditionally stable, the least dissipation at low frequencies for a given spectral radius at
// infinite frequency, 0 to 1, else pbs::InputError: 1 keeps the energy, 0 annihilates the highest modes, in three
// steps.
TimeScheme generalized_alpha(double spectral_radius);

// The state at t_n, #dofs each.
struct Motion {
    Eigen::VectorXd displacement, velocity, acceleration;  // [m], [m/s], [m/s^2]
};

double inertia_coefficient(const TimeScheme& scheme, double step_s);                            // c_m [1/s^2], Eq. (d)
double damping_coefficient(const TimeScheme& scheme, double step_s);                            // c_c [1/s], Eq. (e)
Eigen::VectorXd inertia_centre(const TimeScheme& scheme, const Motion& motion, double step_s);  // w~ [m], Eq. (f)
Eigen::VectorXd damping_centre(const TimeScheme& scheme, const Motion& motion, double step_s);  // w^ [m], Eq. (g)
// Acceleration [m/s^2] of a step of h + `longer_s`, from the one that a step of h ended with and its rate of change
// over it [m/s^3].
Eigen::VectorXd moved_acceleration(const TimeScheme& scheme, const Eigen::VectorXd& acceleration,
                                   const Eigen::VectorXd& rate, double longer_s);
double end_share(const TimeScheme& scheme);  // 1 - alpha_f
// n + 1, Eqs. (b), (c)
Motion accept(const TimeScheme& scheme, const Motion& motion, const Eigen::VectorXd& w, double step_s);

// Velocity and acceleration of degrees of freedom whose displacement is given, from the displacements alone, to second
// order for steps of any length: the slope of the parabola through the last three and the curvature of the cubic
// through the last four, at the end of the step. The scheme's own Eqs. (b), (c) would answer a jump of the given
// velocity by V with a velocity that alternates by 2 V and, for Newmark, with accelerations that grow by 4 V / h a
// step: the weak instability of average acceleration under constraints (A. Cardona, M. Geradin, Computers and
// Structures 33(3), 1989). Here a jump is forgotten after three steps, and its impulse M V is passed on whole.
// Remembers what the past steps did; next() only looks, accept() goes on.
class PrescribedMotion {
public:
    explicit PrescribedMotion(const std::vector<bool>& prescribed);  // #dofs

    void start() { steps_ = 0; }  // of the past only the velocity is known

    // The motion at the end of a step that takes the prescribed degrees of freedom to `values` [m], #dofs; others are
    // left as in `motion`. The first step uses the mean acceleration, which is also that at its beginning.
    Motion next(const Motion& motion, const Eigen::VectorXd& values, double step_s) const;
    void copy(const Motion& from, Motion& to) const;  // the prescribed part
    // Moves on to the next motion after the end of a step was reached.
    void accept(const Motion& motion, const Motion& next, double step_s);

    const std::vector<int>& dofs() const { return dofs_; }  // the prescribed ones, increasing

private:
    struct Differences {
        Eigen::VectorXd slope, curvature;  // first and second divided differences, #prescribed dofs
    };
    Differences differences(const Motion& motion, const Eigen::VectorXd& values, double step_s) const;

    std::vector<int> dofs_;
    int steps_ = 0;
    Differences before_;                                     // over the steps before
    double step_before_s_ = 0.0, step_before_that_s_ = 0.0;  // 0: a velocity instead of a displacement
};

// Constant over all steps of a stepper.
struct TimeStepperOptions {
    TimeScheme scheme = newmark();                               // newmark() or generalized_alpha(radius)
    double density_kg_m3 = 1000.0;                               // of the whole body, finite and > 0
    double rayleigh_mass_1_s = 0.0, rayleigh_stiffness_s = 0.0;  // a, b; finite, >= 0
};

// The prescribed motion during a step, by fractions of the way from its beginning (0) to its end (1).
struct MovingData {
    std::function<Eigen::VectorXd(double fraction)> prescribed;  // displacement [m], #dofs; empty: where it is
    // Moves the terms' own data onto the straight line between two fractions, `share` of the way; empty: they have
    // none.
    std::function<void(double from, double to, double share)> move_terms;
};

// Keeps nothing of space and flesh. Not copied: it would share the factor in `newton`.
class TimeStepper {
public:
    // pbs::InputError where the density is not positive or a damping is negative. `newton` outlives the stepper.
    TimeStepper(const SimplexSpace& space, const std::vector<bool>& prescribed, const Potential& flesh,
                const TimeStepperOptions& options, NewtonMinimiser& newton);
    TimeStepper(const TimeStepper&) = delete;
    TimeStepper& operator=(const TimeStepper&) = delete;

    // Displacement [m] and velocity [m/s], #dofs; no velocity: 0. Time restarts: the first step solves for the
    // acceleration.
    void start(const Eigen::VectorXd& displacement, const Eigen::VectorXd& velocity = {});

    // One step. `guess` [m], #dofs, is where Newton starts, and afterwards the displacement. Where Newton fails the
    // step is halved as a load path is: each part is a step of the scheme of its own length, and the last one lands on
    // fraction 1. Where the end is not reached nothing is kept, neither of the failed part nor of those before it.
    // pbs::InputError unless step_s is finite and > 0.
    LoadPathSummary advance(const Terms& terms, const MovingData& data, double step_s, Eigen::VectorXd& guess,
                            const NewtonOptions& newton, const LoadPathOptions& path);

    const Motion& motion() const { return state_.motion; }  // at the end of the last step that was reached
    // Displacement [m], #dofs, at which Newton's method ended last, whether it converged or not. It belongs to the time
    // within the step at which the scheme balances the forces. Before the first step it has no entries.
    const Eigen::VectorXd& last_iterate() const { return last_iterate_; }
    double kinetic_energy_j() const;                      // v M v / 2
    const ConsistentMass& mass() const { return mass_; }  // M, of density_kg_m3

    // `newton` was used for something else.
    void forget_factor() { factored_step_s_ = 0.0; }

private:
    struct State {
        Motion motion;
        PrescribedMotion prescribed;
        double last_step_s = 0.0;           // 0: before the first
        Eigen::VectorXd acceleration_rate;  // over the last step [m/s^3]
    };
    NewtonSummary attempt(const Terms& terms, const MovingData& data, double from, double to, double step_s,
                          Eigen::VectorXd& guess, const NewtonOptions& options);
    Eigen::VectorXd start_acceleration(const Terms& terms, const Eigen::VectorXd& of_prescribed);
    Eigen::VectorXd later_acceleration(double step_s) const;
    void set_damping(double coefficient, const Eigen::VectorXd& centre);
    void set_centres(const Motion& now, const Motion& end, double step_s);
    Terms with_inertia(const Terms& terms) const;
    void accept_step(const Motion& now, const Motion& end, const Eigen::VectorXd& w, double step_s);

    std::vector<bool> fixed_;
    TimeStepperOptions options_;
    NewtonMinimiser& newton_;
    ConsistentMass mass_;
    InertiaPotential inertia_, mass_damping_;
    std::unique_ptr<StiffnessPotential> stiffness_damping_;  // null: b = 0
    State state_;
    Eigen::VectorXd last_iterate_;
    double factored_step_s_ = 0.0;  // 0: newton_ keeps no factor of ours
};

}  // namespace reference_fem

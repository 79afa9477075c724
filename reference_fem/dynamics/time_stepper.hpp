// Steps a sum of potentials through time: M u'' + C u' + grad Pi(u) = 0, some degrees of freedom prescribed, by either scheme of
// time_scheme.hpp. Consistent mass; Rayleigh's damping C = a M + b K, K the flesh's stiffness at rest.
//   TimeStepper stepper(space, prescribed, flesh, {.density_kg_m3 = 1000.0}, newton);
//   stepper.start(u0, v0);  // the acceleration follows from the balance of forces
//   const LoadPathSummary step = stepper.advance({&flesh, &springs}, data, step_s, displacement, {}, {});
//   stepper.motion();
// C is that of the rest pose: once a body has turned, b K resists rigid rotation too; a M resists all motion, rigid or not.
#pragma once

#include "reference_fem/dynamics/inertia_potential.hpp"
#include "reference_fem/dynamics/prescribed_motion.hpp"
#include "reference_fem/newton/load_path.hpp"
#include "reference_fem/potentials/stiffness_potential.hpp"

namespace reference_fem {

// Constant over all steps of a stepper.
struct TimeStepperOptions {
    TimeScheme scheme = newmark();                               // newmark() or generalized_alpha(radius)
    double density_kg_m3 = 1000.0;                               // of the whole body, finite and > 0
    double rayleigh_mass_1_s = 0.0, rayleigh_stiffness_s = 0.0;  // a, b; finite, >= 0
};

// The prescribed motion during a step, by fractions of the way from its beginning (0) to its end (1).
struct MovingData {
    std::function<Eigen::VectorXd(double fraction)> prescribed;  // displacement [m], #dofs; empty: where it is
    // Moves the terms' own data onto the straight line between two fractions, `share` of the way; empty: they have none.
    std::function<void(double from, double to, double share)> move_terms;
};

// Keeps nothing of space and flesh. Not copied: it would share the factor in `newton`.
class TimeStepper {
public:
    // pbs::InputError where the density is not positive or a damping is negative. `newton` outlives the stepper.
    TimeStepper(const SimplexSpace& space, const std::vector<bool>& prescribed, const Potential& flesh, const TimeStepperOptions& options,
                NewtonMinimiser& newton);
    TimeStepper(const TimeStepper&) = delete;
    TimeStepper& operator=(const TimeStepper&) = delete;

    // Displacement [m] and velocity [m/s], #dofs; no velocity: 0. Time restarts: the first step solves for the acceleration.
    void start(const Eigen::VectorXd& displacement, const Eigen::VectorXd& velocity = {});

    // One step. `guess` [m], #dofs, is where Newton starts, and afterwards the displacement. Where Newton fails the step is halved as a
    // load path is: each part is a step of the scheme of its own length, and the last one lands on fraction 1. Where the end is not reached
    // nothing is kept, neither of the failed part nor of those before it. pbs::InputError unless step_s is finite and > 0.
    LoadPathSummary advance(const Terms& terms, const MovingData& data, double step_s, Eigen::VectorXd& guess, const NewtonOptions& newton,
                            const LoadPathOptions& path);

    const Motion& motion() const { return state_.motion; }  // at the end of the last step that was reached
    // Displacement [m], #dofs, at which Newton's method ended last, whether it converged or not. It belongs to the time within the step at
    // which the scheme balances the forces. Before the first step it has no entries.
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
    NewtonSummary attempt(const Terms& terms, const MovingData& data, double from, double to, double step_s, Eigen::VectorXd& guess,
                          const NewtonOptions& options);
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

// A body of the linear law that vibrates freely: its modes, energies and damping are known in closed form. No skeleton
// holds it, as in a BoundaryValueProblem. It has the elements, mass, solver and time stepper of the reference.
//   VibratingBody bar(mesh, {.held = [](const pbs::Vec3& x) { return x.x() < 1e-9; }});
//   const Mode mode = bar.first_mode();
//   TimeStepper time = bar.stepper({.scheme = generalized_alpha(0.8)});
//   time.start(mode.shape);
//   bar.run(time, step_s, steps);
#pragma once

#include "reference_fem/boundary_value_problem.hpp"
#include "reference_fem/dynamics/time_stepper.hpp"
#include "reference_fem/options.hpp"

#include <vector>

namespace reference_fem {

// The lowest mode of free vibration: K phi = omega^2 M phi, phi = 0 where prescribed. By subspace iteration (K.-J.
// Bathe, Finite Element Procedures, 1996, section 11.6), which separates modes of nearly equal frequency, such as those
// of a bar of square section. The frequency in Hz is omega / (2 pi).
struct Mode {
    double omega_rad_s = 0.0;  // not a number where the stiffness is singular: a body that may move rigidly
    Eigen::VectorXd shape;     // #dofs, the largest component 1 [m]
};

// stiffness [N/m], #dofs x #dofs, both triangles, nothing eliminated; prescribed: #dofs. From a fixed random block of 8
// vectors, until the shape changes by less than 1e-13 of itself or 100 iterations are done. No degree of freedom free:
// not a number.
Mode first_mode(const SparseMatrix& stiffness, const ConsistentMass& mass, const std::vector<bool>& prescribed,
                LinearSolver solver = LinearSolver::cholmod);

// Out of bounds: pbs::InputError from the constructor, of the density from stepper().
struct VibratingOptions {
    int element_order = 2;                                         // 1, 2
    double young_pa = 1e5, poisson = 0.3, density_kg_m3 = 1000.0;  // E > 0, -1 < nu < 0.5, density > 0
    std::function<Held(const pbs::Vec3& node)> held = {};          // empty: none
};

// The body is undamped except for the damping in the options of a stepper.
class VibratingBody {
public:
    // pbs::InputError for a mesh that check_mesh refuses. The mesh may go.
    VibratingBody(const pbs::TetMesh& mesh, const VibratingOptions& options);

    const SimplexSpace& space() const { return space_; }        // its node v is vertex v of the mesh
    const std::vector<bool>& fixed() const { return fixed_; }   // #dofs
    const StiffnessPotential& flesh() const { return flesh_; }  // u K u / 2 [J]
    const ConsistentMass& mass() const { return mass_; }        // M, of density_kg_m3
    // Not a number where the body may move rigidly.
    Mode first_mode() const { return reference_fem::first_mode(stiffness_.matrix(), mass_, fixed_); }

    // The density is the body's. One stepper at a time: they share the factor.
    TimeStepper stepper(TimeStepperOptions options);

    // `steps` steps of free motion, each looked at by after_step(number from 1); false: one did not converge.
    bool run(TimeStepper& stepper, double step_s, int steps, const std::function<void(int)>& after_step = {}) const;

    double energy_j(const TimeStepper& stepper) const;  // of strain and of motion
    // How much of a mode there is in the motion: phi M u / phi M phi.
    double amplitude(const TimeStepper& stepper, const Mode& mode) const;

private:
    SimplexSpace space_;
    std::vector<bool> fixed_;
    double density_kg_m3_;
    NodalMatrix stiffness_;
    StiffnessPotential flesh_;
    ConsistentMass mass_;
    NewtonMinimiser newton_;
};

}  // namespace reference_fem

// A bar along x held at x = 0 that vibrates freely: its stiffness, mass, modes, and the loop through time.
//   VibratingBar bar(mesh, {.element_order = 2});
//   const Mode first = bar.first_mode();
//   TimeStepper stepper = bar.stepper({.scheme = newmark()});
#pragma once

#include "reference_fem/dynamics/time_stepper.hpp"
#include "reference_fem/eliminated_system.hpp"
#include "reference_fem/potentials/elastic_potential.hpp"

#include "tests/support/structured_bar.hpp"

#include <cmath>
#include <random>

namespace test_support {

struct BarMaterial {
    int element_order = 1;
    double young_pa = 1e5, poisson = 0.3, density_kg_m3 = 1000.0;
};

// K phi = omega^2 M phi at the free degrees of freedom; largest component of the shape 1 [m].
struct Mode {
    double omega_rad_s = 0.0;
    Eigen::VectorXd shape;
};

class VibratingBar {
public:
    VibratingBar(const pbs::TetMesh& mesh, const BarMaterial& material)
        : space(mesh, material.element_order),
          fixed(space.dofs()),
          material_(material),
          law_(space, reference_fem::Model::linear, reference_fem::lame_parameters(material.young_pa, material.poisson),
               reference_fem::Formulation::displacement),
          stiffness_(reference_fem::rest_stiffness(space, law_)),
          flesh(stiffness_),
          newton(space, held_at_x_0(), reference_fem::LinearSolver::cholmod),
          mass(space, material.density_kg_m3)
    {
    }

    reference_fem::TimeStepper stepper(reference_fem::TimeStepperOptions options)
    {
        options.density_kg_m3 = material_.density_kg_m3;
        newton.forget_factor();
        return {space, fixed, flesh, options, newton};
    }

    // n steps of free motion; `after_step(k, stepper)` looks at each.
    template <typename AfterStep>
    void run(reference_fem::TimeStepper& stepper, double step_s, int steps, AfterStep after_step) const
    {
        Eigen::VectorXd guess = stepper.motion().displacement;
        for (int k = 1; k <= steps; ++k) {
            if (!stepper.advance({&flesh}, {}, step_s, guess, {}, {}).converged()) throw std::runtime_error("a linear step failed");
            after_step(k, stepper);
        }
    }
    void run(reference_fem::TimeStepper& stepper, double step_s, int steps) const
    {
        run(stepper, step_s, steps, [](int, const auto&) {});
    }

    double energy_j(const reference_fem::TimeStepper& stepper) const
    {
        return flesh.value(stepper.motion().displacement) + stepper.kinetic_energy_j();
    }

    // Inverse iteration: phi <- K^-1 M phi.
    Mode first_mode() const
    {
        Eigen::VectorXd bent = Eigen::VectorXd::Zero(space.dofs());
        for (int node = 0; node < space.nodes(); ++node) bent(3 * node + 2) = std::pow(space.node_positions()(node, 0), 2);
        const SparseMatrix& stiffness = stiffness_.matrix();
        const reference_fem::EliminatedSystem system(stiffness, fixed, reference_fem::LinearSolver::cholmod);
        return iterate(bent, [&](const Eigen::VectorXd& phi) { return solve(system, mass.times(phi)); });
    }
    // Power iteration: phi <- M^-1 K phi.
    Mode last_mode() const
    {
        const SparseMatrix matrix = mass.matrix();
        const reference_fem::EliminatedSystem system(matrix, fixed, reference_fem::LinearSolver::cholmod);
        return iterate(random_free_vector(), [&](const Eigen::VectorXd& phi) { return solve(system, stiffness_.matrix() * phi); });
    }

    // Entries in -1 to 1, 0 where the bar is held.
    Eigen::VectorXd random_free_vector() const
    {
        std::mt19937 random(7);
        std::uniform_real_distribution<double> entry(-1.0, 1.0);
        Eigen::VectorXd vector(space.dofs());
        for (Eigen::Index i = 0; i < vector.size(); ++i) vector(i) = fixed[i] ? 0.0 : entry(random);
        return vector;
    }

    reference_fem::SimplexSpace space;
    std::vector<bool> fixed;  // #dofs

private:
    using SparseMatrix = reference_fem::SparseMatrix;

    const std::vector<bool>& held_at_x_0()
    {
        for (int node = 0; node < space.nodes(); ++node)
            for (int c = 0; c < 3; ++c) fixed[3 * node + c] = space.node_positions()(node, 0) < 1e-9;
        return fixed;
    }

    Eigen::VectorXd solve(const reference_fem::EliminatedSystem& system, const Eigen::VectorXd& load) const
    {
        return system.solve(load, Eigen::VectorXd::Zero(space.dofs())).displacement;
    }

    // Until the Rayleigh quotient stands still to rounding and the shape with it.
    template <typename Apply>
    Mode iterate(Eigen::VectorXd phi, Apply apply) const
    {
        Mode mode;
        for (int k = 0; k < 2000; ++k) {
            const Eigen::VectorXd before = phi;
            phi = apply(phi);
            Eigen::Index largest = 0;
            phi.cwiseAbs().maxCoeff(&largest);
            phi /= phi(largest);
            if ((phi - before).norm() < 1e-13 * phi.norm()) break;
        }
        mode.shape = phi;
        mode.omega_rad_s = std::sqrt(phi.dot(stiffness_.matrix() * phi) / phi.dot(mass.times(phi)));
        return mode;
    }

    BarMaterial material_;
    reference_fem::ElasticPotential law_;
    reference_fem::NodalMatrix stiffness_;

public:
    reference_fem::StiffnessPotential flesh;  // K by its matrix
    reference_fem::NewtonMinimiser newton;
    reference_fem::ConsistentMass mass;
};

}  // namespace test_support

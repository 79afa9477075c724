// Projective dynamics in equilibrium: minimises ProjectiveEnergy (projective_dynamics.hpp, where its sources are).
//   const double share = volume_share_of_projective(poisson, true);
//   const HeldFlesh flesh(mesh, springs, bones, {.poisson = poisson, .volume_share = share});
//   const ProjectiveEnergy energy(mesh, projective_weights(poisson, true), flesh.hold());
//   ProjectiveDynamics<float> solver(mesh, energy, flesh.factor(), {.iterations = 30});
//   flesh.hold().centres(pose, centres);
//   ProjectiveSummary summary = solver.minimise(centres, x);   // x: the initial guess in, the last iterate out
// An iteration projects every tet (local step) and minimises E with R and D fixed (global step), a system whose matrix is constant and
// factored once. It is written as x <- x - H^-1 grad E(x), which is the same (T. Liu, S. Bouaziz, L. Kavan 2017). E never increases,
// except for rounding.
#pragma once

#include "pbs/flesh/flesh_system.hpp"

#include <vector>

namespace pbs {

struct ProjectiveOptions {
    int iterations = 30;     // at most
    double stop_step = 0.0;  // stop where the norm of a step is below this share of the first one, or rounding; 0: never
    Arithmetic arithmetic = Arithmetic::packed_f32;
    int threads = 1;
};

struct ProjectiveSummary {
    int iterations = 0;
    bool converged = false;        // stop_step was reached
    std::vector<double> energies;  // at the beginning of each iteration, over Young's modulus [m^3]
    std::vector<double> steps;     // norm of each step [m]
};

template <typename Scalar>
class ProjectiveDynamics {
public:
    // factor: of the matrix of the global step. Scalar is that of the arithmetic (unchecked).
    ProjectiveDynamics(const TetMesh& mesh, const ProjectiveEnergy& energy, const CholeskyFactor& factor, const ProjectiveOptions& options);

    ProjectiveSummary minimise(const Positions& centres, Positions& x);  // x [m], #V x 3; a step that is not finite ends it
    std::size_t bytes_an_iteration() const { return system_->bytes(); }

private:
    ProjectiveOptions options_;
    std::unique_ptr<FleshSystem<Scalar>> system_;
    Rows<Scalar> x_, step_;
};

}  // namespace pbs

// Projective dynamics in equilibrium (S. Bouaziz et al., Projective dynamics, 2014; for skinning M. Komaritzan, M. Botsch, Projective
// skinning, Proc. ACM Comput. Graph. Interact. Tech. 1(1), 2018) of flesh on linear tets that its bones hold by springs (bone_springs.hpp):
//   E(x) = sum_tets V0 [ mu |F - R(F)|^2 + 3 lambda / 2 |F - D(F)|^2 ] + springs
// R(F) is the nearest rotation and D(F) the nearest matrix of determinant one. mu and lambda are Lame's constants; with these weights, 2 mu
// V0 and 3 lambda V0 in the notation of the paper, E is linear elasticity where strains are small, since |F - D|^2 is then a third of the
// squared trace of the strain. For large strains it is another material than that of FleshEnergy, so that its limit is another shape.
//   ProjectiveDynamics solver(mesh, hold, {.poisson = 0.45, .iterations = 30});
//   hold.centres(pose, centres);
//   ProjectiveSummary summary = solver.minimise(centres, x);   // x: the initial guess in, the last iterate out
// An iteration projects every tet (local step) and minimises E with R and D fixed (global step), a system whose matrix is constant and
// factored once. It is written as x <- x - H^-1 grad E(x), which is the same (T. Liu, S. Bouaziz, L. Kavan 2017). E never increases. Plain
// code in double; everything is over Young's modulus.
#pragma once

#include "pbs/flesh/bone_springs.hpp"
#include "pbs/flesh/cholesky.hpp"

#include <vector>

namespace pbs {

struct ProjectiveOptions {
    double poisson = 0.45;     // from 0 inclusive to 1/2 exclusive
    int iterations = 30;       // at most
    double stop_step = 0.0;    // stop where the norm of a step is below this share of the first one; 0: never
    bool keeps_volume = true;  // false: without the second term, for comparison (Komaritzan and Botsch 2018 have none)
};

struct ProjectiveSummary {
    int iterations = 0;
    bool converged = false;        // stop_step was reached
    std::vector<double> energies;  // at the beginning of each iteration [m^3]
    std::vector<double> steps;     // norm of each step [m]
};

class ProjectiveDynamics {
public:
    // InputError: a tet without volume, poisson out of range, or the module of CHOLMOD is missing. The hold must outlive the solver.
    ProjectiveDynamics(const TetMesh& mesh, const BoneHold& hold, const ProjectiveOptions& options);

    ProjectiveSummary minimise(const Positions& centres, Positions& x);  // x [m], #V x 3; a step that is not finite ends it

    // Returns E but for a constant [m^3], and sets its gradient [m^2], #V x 3.
    double value_and_gradient(const Positions& x, const Positions& centres, Positions& gradient) const;

    const Eigen::SparseMatrix<double>& matrix() const { return matrix_; }  // H, its lower triangle [m]

private:
    struct Tet {
        Eigen::Vector4i vertex;
        Eigen::Matrix<double, 3, 4> gradients;  // of the barycentric coordinates [1/m]
        double volume;                          // at rest [m^3]
    };

    const BoneHold* hold_;
    ProjectiveOptions options_;
    double strain_weight_, volume_weight_;  // 2 mu, 3 lambda
    std::vector<Tet> tets_;
    Eigen::SparseMatrix<double> matrix_;
    CholeskyFactor factor_;
    std::vector<int> place_;
    std::vector<double> work_;
};

}  // namespace pbs

// Projective dynamics in equilibrium: minimises ProjectiveEnergy, where its sources are.
//   const double share = volume_share_of_projective(poisson, true);
//   const HeldFlesh flesh(mesh, springs, bones, {.poisson = poisson, .volume_share = share});
//   const ProjectiveEnergy energy(mesh, projective_weights(poisson, true), flesh.hold());
//   ProjectiveDynamics<float> solver(mesh, energy, flesh.factor(), {.iterations = 30});
//   flesh.hold().centres(pose, centres);
//   ProjectiveSummary summary = solver.minimise(centres, x);   // x: the initial guess in, the last iterate out
// An iteration projects every tet (local step) and minimises E with R and D fixed (global step), a system whose matrix
// is constant and factored once. It is written as x <- x - H^-1 grad E(x), which is the same (T. Liu, S. Bouaziz, L.
// Kavan 2017). E never increases, except for rounding.
#pragma once

#include "pbs/flesh/bone_springs.hpp"
#include "pbs/flesh/flesh_system.hpp"
#include "pbs/geometry/tet_mesh.hpp"

#include <array>
#include <vector>

namespace pbs {

struct ProjectiveOptions {
    int iterations = 30;  // at most
    double stop_step =
        0.0;             // stop where the norm of a step is below this share of the first one, or rounding; 0: never
    bool packed = true;  // several elements side by side; false: plain code, one after the other, in double
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
    // factor: of the matrix of the global step. Plain code is in double: packed false needs Scalar double (unchecked).
    ProjectiveDynamics(const TetMesh& mesh, const ProjectiveEnergy& energy, const CholeskyFactor& factor,
                       const ProjectiveOptions& options);

    // x [m], #V x 3; a step that is not finite ends it
    ProjectiveSummary minimise(const Positions& centres, Positions& x);

private:
    ProjectiveOptions options_;
    std::unique_ptr<FleshSystem<Scalar>> system_;
    Rows<Scalar> x_, step_;
};

// The energy of projective dynamics in equilibrium (S. Bouaziz et al., Projective dynamics, 2014; for skinning M.
// Komaritzan, M. Botsch, Projective skinning, Proc. ACM Comput. Graph. Interact. Tech. 1(1), 2018) of flesh on linear
// tets that its bones hold by springs (bone_springs.hpp):
//   E(x) = sum_tets V0 [ mu |F - R(F)|^2 + 3 lambda / 2 |F - D(F)|^2 ] + springs
// R(F) is the nearest rotation and D(F) the nearest matrix of determinant one. mu and lambda are Lame's constants; with
// these weights, 2 mu V0 and 3 lambda V0 in the notation of the paper, E is linear elasticity where strains are small,
// since |F - D|^2 is then a third of the squared trace of the strain. For large strains it is another material than
// that of FleshEnergy, so that its limit is another shape.
//   const ProjectiveEnergy energy(mesh, projective_weights(0.45, true), hold);
//   double e = energy.value_and_gradient(x, centres, gradient);
// This is the plain implementation in double, by which the packed one is verified. Everything is over Young's modulus.

// Twice the factors of |F - R|^2 and |F - D|^2.
struct ProjectiveWeights {
    double strain = 0.0;  // 2 mu
    double volume = 0.0;  // 3 lambda
};

// keeps_volume: false without the second term (Komaritzan and Botsch 2018 have none). poisson: from 0 inclusive to 1/2
// exclusive; an InputError otherwise.
ProjectiveWeights projective_weights(double poisson, bool keeps_volume);

// The volume_share with which the Laplacian of HeldFlesh is the matrix of the global step, E with R and D fixed.
double volume_share_of_projective(double poisson, bool keeps_volume);

struct ProjectiveTet {
    std::array<int, 4> vertex;
    Eigen::Matrix3d
        inverse_edges;  // of the matrix with the edges 01, 02, 03 at rest as columns [1/m]: F = edges * inverse_edges
    double volume;      // at rest, times sliver_factor [m^3]
    std::array<double, 6> w;  // of the springs on the edges 01 02 03 12 13 23 [m]
};

// The two terms of one tet.
struct ProjectiveForces {
    double value;             // [m^3]
    Eigen::Matrix3d columns;  // derivatives by the corners 1, 2, 3; that by corner 0 is minus their sum [m^2]
};
ProjectiveForces projective_forces(const ProjectiveTet& tet, const ProjectiveWeights& weights,
                                   const Eigen::Matrix3d& edges);

class ProjectiveEnergy {
public:
    // Tets of positive rest volume; an InputError otherwise.
    ProjectiveEnergy(const TetMesh& mesh, const ProjectiveWeights& weights, const BoneHold& hold);

    // Returns E up to a constant [m^3], and sets its gradient [m^2], #V x 3.
    double value_and_gradient(const Positions& x, const Positions& centres, Positions& gradient) const;

    const ProjectiveWeights& weights() const { return weights_; }
    const std::vector<ProjectiveTet>& tets() const { return tets_; }
    const Eigen::VectorXd& hold() const { return hold_; }  // a_i, #V

private:
    ProjectiveWeights weights_;
    std::vector<ProjectiveTet> tets_;
    Eigen::VectorXd hold_;
};

// The matrix of determinant one that is nearest to a deformation gradient, the local step for volumes of projective
// dynamics (S. Bouaziz, S. Martin, T. Liu, L. Kavan, M. Pauly: Projective dynamics, ACM Transactions on Graphics 33(4),
// 2014).
//   const LocalShapes local = local_shapes(f);   // rotation and volume-preserving matrix nearest to F

// s* with s*_1 s*_2 s*_3 = 1 that is nearest to s. s: two numbers of zero or more, and a third of either sign, of no
// larger magnitude. The condition of the minimum is s*_i - s_i + kappa / s*_i = 0 for all i with one kappa, so that a
// single unknown is left; it is found between bounds by Newton's method and bisection.
Vec3 nearest_unit_product(const Vec3& s);

struct LocalShapes {
    Eigen::Matrix3d rotation;     // nearest to F with det = +1
    Eigen::Matrix3d unit_volume;  // nearest to F with det = 1
};

// Both by F = R V diag(s) V^T, with R of nearest_rotation.hpp. All entries are not a number where F is not finite.
LocalShapes local_shapes(const Eigen::Matrix3d& f);

}  // namespace pbs

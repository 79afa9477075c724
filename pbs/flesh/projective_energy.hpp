// The energy of projective dynamics in equilibrium (S. Bouaziz et al., Projective dynamics, 2014; for skinning M. Komaritzan, M. Botsch,
// Projective skinning, Proc. ACM Comput. Graph. Interact. Tech. 1(1), 2018) of flesh on linear tets that its bones hold by springs
// (bone_springs.hpp):
//   E(x) = sum_tets V0 [ mu |F - R(F)|^2 + 3 lambda / 2 |F - D(F)|^2 ] + springs
// R(F) is the nearest rotation and D(F) the nearest matrix of determinant one. mu and lambda are Lame's constants; with these weights, 2 mu
// V0 and 3 lambda V0 in the notation of the paper, E is linear elasticity where strains are small, since |F - D|^2 is then a third of the
// squared trace of the strain. For large strains it is another material than that of FleshEnergy, so that its limit is another shape.
//   const ProjectiveEnergy energy(mesh, projective_weights(0.45, true), hold);
//   double e = energy.value_and_gradient(x, centres, gradient);
// This is the plain implementation in double, by which the packed one is verified. Everything is over Young's modulus.
#pragma once

#include "pbs/flesh/bone_springs.hpp"
#include "pbs/geometry/tet_mesh.hpp"

#include <array>
#include <vector>

namespace pbs {

// Twice the factors of |F - R|^2 and |F - D|^2.
struct ProjectiveWeights {
    double strain = 0.0;  // 2 mu
    double volume = 0.0;  // 3 lambda
};

// keeps_volume: false without the second term (Komaritzan and Botsch 2018 have none). poisson: from 0 inclusive to 1/2 exclusive; an
// InputError otherwise.
ProjectiveWeights projective_weights(double poisson, bool keeps_volume);

// The volume_share with which the Laplacian of HeldFlesh is the matrix of the global step, E with R and D fixed.
double volume_share_of_projective(double poisson, bool keeps_volume);

struct ProjectiveTet {
    std::array<int, 4> vertex;
    Eigen::Matrix3d inverse_edges;  // of the matrix with the edges 01, 02, 03 at rest as columns [1/m]: F = edges * inverse_edges
    double volume;                  // at rest [m^3]
    std::array<double, 6> w;        // of the springs on the edges 01 02 03 12 13 23 [m]
};

// The two terms of one tet.
struct ProjectiveForces {
    double value;             // [m^3]
    Eigen::Matrix3d columns;  // derivatives by the corners 1, 2, 3; that by corner 0 is minus their sum [m^2]
};
ProjectiveForces projective_forces(const ProjectiveTet& tet, const ProjectiveWeights& weights, const Eigen::Matrix3d& edges);

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

}  // namespace pbs

// The energy of elastic flesh on linear tets that its bones hold, as sums over tets and vertices:
//   E(x) = sum_tets [ sum_{i<j} w_ij / 2 |x_i - x_j|^2 + kappa / 2 (6 V(x) - d)^2 ] + sum_i a_i / 2 |x_i - c_i|^2 + constant.
// V(x) is the signed volume of a tet. w_ij = -mu V0 grad N_i . grad N_j - sum_s k_s beta_i beta_j (flesh_energy.hpp, bone_springs.hpp),
// kappa = lambda / (36 V0) and d = 6 alpha V0. Only the centres c_i depend on the pose. |F|^2 is quadratic and V(x) is affine in each
// single vertex, so that the energy along one vertex is exactly quadratic.
//   const FleshEnergy energy(mesh, flesh_material(0.45), hold);
//   hold.centres(pose, centres);
//   double e = energy.value(x, centres);
// This is the plain implementation in double, by which the packed one is verified.
#pragma once

#include "pbs/flesh/bone_springs.hpp"
#include "pbs/geometry/tet_mesh.hpp"

#include <Eigen/SparseCore>

#include <array>
#include <vector>

namespace pbs {

// The terms of one tet.
struct FleshTet {
    std::array<int, 4> vertex;
    std::array<double, 6> w;  // of the edges 01 02 03 12 13 23, over Young's modulus [m]
    double kappa;             // over Young's modulus [1/m^3]
    double d;                 // [m^3]
};

class FleshEnergy {
public:
    // Tets of positive rest volume; an InputError otherwise.
    FleshEnergy(const TetMesh& mesh, const FleshMaterial& material, const BoneHold& hold);

    double value(const Positions& x, const Positions& centres) const;  // without the constant, over Young's modulus [m^3]
    // Returns the value, and sets the gradient over Young's modulus [m^2], #V x 3.
    double value_and_gradient(const Positions& x, const Positions& centres, Positions& gradient) const;

    const std::vector<FleshTet>& tets() const { return tets_; }
    const Eigen::VectorXd& hold() const { return hold_; }  // a_i, #V

private:
    std::vector<FleshTet> tets_;
    Eigen::VectorXd hold_;
};

// The matrix H of sum_{i<j} h_ij / 2 |x_i - x_j|^2 + sum_i a_i / 2 |x_i|^2, its lower triangle over Young's modulus [m]: the energy without
// its volume term, instead of which |F|^2 pulls as if mu were larger by volume_share * lambda. It is constant, and positive definite on
// every part of the body that a spring holds. A part that none holds gets a hold of 1e-9 of its diagonal.
Eigen::SparseMatrix<double> flesh_laplacian(const TetMesh& mesh, const FleshMaterial& material, const FleshEnergy& energy,
                                            double volume_share);

}  // namespace pbs

// The energy of elastic flesh on linear tets that its bones hold, as sums over tets and vertices:
//   E(x) = sum_tets [ sum_{i<j} w_ij / 2 |x_i - x_j|^2 + kappa / 2 (6 V(x) - d)^2 ]
//          + sum_i a_i / 2 |x_i - c_i|^2 + constant.
// V(x) is the signed volume of a tet. w_ij = -mu V0 grad N_i . grad N_j - sum_s k_s beta_i beta_j (FleshMaterial,
// bone_springs.hpp), kappa = lambda / (36 V0) and d = 6 alpha V0. Only the centres c_i depend on the pose. |F|^2 is
// quadratic and V(x) is affine in each single vertex, so that the energy along one vertex is exactly quadratic.
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

// The material of the flesh: neo-Hookean without logarithm (M. Macklin, M. Mueller, A constraint-based formulation of
// stable neo-Hookean materials, MIG 2021),
//   psi(F) = mu / 2 (|F|^2 - 3) + lambda / 2 (J - alpha)^2,   J = det F,   alpha = 1 + mu / lambda.
// With these constants it has Poisson's ratio at small strains, and equals stable_neo_hookean_law of the reference up
// to a constant. The energy is finite for every F, so that inverted tets need no exception. It is relative to Young's
// modulus, which no shape depends on, because the springs of the bones are relative to it, too.
struct FleshMaterial {
    double mu = 0.0, lambda = 0.0;  // over Young's modulus
    double alpha = 1.0;             // the J at which the volume term is zero
};

// poisson: from 0 inclusive to 1/2 exclusive; an InputError otherwise.
FleshMaterial flesh_material(double poisson);

// The factor on the energy of a tet: 1, except for a sliver, whose volume is below 1e-5 of its longest edge cubed.
// Across its plane a tet resists the more, the flatter it is, so that a minimiser could turn a sliver only in steps of
// its height. Its volume does not matter, and it is taken as stiff as a regular tet with the same longest edge.
double sliver_factor(const TetMesh& mesh, Eigen::Index tet);

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

    // without the constant, over Young's modulus [m^3]
    double value(const Positions& x, const Positions& centres) const;
    // Returns the value, and sets the gradient over Young's modulus [m^2], #V x 3.
    double value_and_gradient(const Positions& x, const Positions& centres, Positions& gradient) const;

    const std::vector<FleshTet>& tets() const { return tets_; }
    const Eigen::VectorXd& hold() const { return hold_; }  // a_i, #V
    int slivers() const { return slivers_; }               // tets whose sliver_factor is not 1

private:
    std::vector<FleshTet> tets_;
    Eigen::VectorXd hold_;
    int slivers_ = 0;
};

// The matrix H of sum_{i<j} h_ij / 2 |x_i - x_j|^2 + sum_i a_i / 2 |x_i|^2, its lower triangle over Young's modulus
// [m]: the energy without its volume term, instead of which |F|^2 pulls as if mu were larger by volume_share * lambda.
// It is constant, and positive definite on every part of the body that a spring holds. A part that none holds gets a
// hold of 1e-9 of its diagonal.
Eigen::SparseMatrix<double> flesh_laplacian(const TetMesh& mesh, const FleshMaterial& material,
                                            const FleshEnergy& energy, double volume_share);

// The second derivative of the energy in x, its lower triangle over Young's modulus [m], 3 #V x 3 #V; vertex i has the
// rows 3 i to 3 i + 2. At rest it is the stiffness matrix of linear elasticity and of the springs. All nine entries of
// a block are stored, those above the diagonal of a block on the diagonal excepted.
Eigen::SparseMatrix<double> flesh_hessian(const FleshEnergy& energy, const Positions& x);

// The two constraints of a neo-Hookean tet of M. Macklin, M. Mueller, A constraint-based formulation of stable
// neo-Hookean materials, MIG 2021, as functions of the deformation gradient F:
//   hydrostatic  C_H = det F - alpha        of compliance 1 / (lambda V),
//   deviatoric   C_D = sqrt(tr(F^T F))      of compliance 1 / (mu V).
// The energies C^2 / (2 compliance) add up to V psi(F) of FleshMaterial, except for the constant -3 mu V / 2.
//   const Eigen::Matrix3d F = deformation_gradient(tet, p1, p2, p3, p4);
//   double C = hydrostatic_value(F, material.alpha);
//   Eigen::Matrix<double, 3, 4> of_vertices = vertex_gradients(tet, hydrostatic_gradient(F));
struct NeoHookeanTet {
    std::array<int, 4> vertex;
    // Inverse of the matrix with the columns X2 - X1, X3 - X1, X4 - X1 [1/m]. Its rows are the gradients of the
    // barycentric coordinates of the last three vertices.
    Eigen::Matrix3d rest_inverse;
    double volume;  // at rest [m^3]
};

// Tets of positive rest volume; an InputError otherwise.
std::vector<NeoHookeanTet> neo_hookean_tets(const TetMesh& mesh);

Eigen::Matrix3d deformation_gradient(const NeoHookeanTet& tet, const Vec3& p1, const Vec3& p2, const Vec3& p3,
                                     const Vec3& p4);

double hydrostatic_value(const Eigen::Matrix3d& F, double alpha);
Eigen::Matrix3d hydrostatic_gradient(const Eigen::Matrix3d& F);  // dC_H/dF, the cofactors of F
double deviatoric_value(const Eigen::Matrix3d& F);
// dC_D/dF = F / C_D; zero where C_D is zero, because the force C_D dC_D/dF is zero there.
Eigen::Matrix3d deviatoric_gradient(const Eigen::Matrix3d& F);

// dC/dx_i [1/m], one per column, from dC/dF. They add up to zero.
Eigen::Matrix<double, 3, 4> vertex_gradients(const NeoHookeanTet& tet, const Eigen::Matrix3d& dC_dF);

}  // namespace pbs

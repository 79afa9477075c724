// The two constraints of a neo-Hookean tet of M. Macklin, M. Mueller, A constraint-based formulation of stable neo-Hookean materials, MIG
// 2021, as functions of the deformation gradient F:
//   hydrostatic  C_H = det F - alpha        of compliance 1 / (lambda V),
//   deviatoric   C_D = sqrt(tr(F^T F))      of compliance 1 / (mu V).
// The energies C^2 / (2 compliance) add up to V psi(F) of flesh_energy.hpp, except for the constant -3 mu V / 2.
//   const Eigen::Matrix3d F = deformation_gradient(tet, p1, p2, p3, p4);
//   double C = hydrostatic_value(F, material.alpha);
//   Eigen::Matrix<double, 3, 4> of_vertices = vertex_gradients(tet, hydrostatic_gradient(F));
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <array>
#include <vector>

namespace pbs {

struct NeoHookeanTet {
    std::array<int, 4> vertex;
    // Inverse of the matrix with the columns X2 - X1, X3 - X1, X4 - X1 [1/m]. Its rows are the gradients of the barycentric coordinates of
    // the last three vertices.
    Eigen::Matrix3d rest_inverse;
    double volume;  // at rest [m^3]
};

// Tets of positive rest volume; an InputError otherwise.
std::vector<NeoHookeanTet> neo_hookean_tets(const TetMesh& mesh);

Eigen::Matrix3d deformation_gradient(const NeoHookeanTet& tet, const Vec3& p1, const Vec3& p2, const Vec3& p3, const Vec3& p4);

double hydrostatic_value(const Eigen::Matrix3d& F, double alpha);
Eigen::Matrix3d hydrostatic_gradient(const Eigen::Matrix3d& F);  // dC_H/dF, the cofactors of F
double deviatoric_value(const Eigen::Matrix3d& F);
// dC_D/dF = F / C_D; zero where C_D is zero, because the force C_D dC_D/dF is zero there.
Eigen::Matrix3d deviatoric_gradient(const Eigen::Matrix3d& F);

// dC/dx_i [1/m], one per column, from dC/dF. They add up to zero.
Eigen::Matrix<double, 3, 4> vertex_gradients(const NeoHookeanTet& tet, const Eigen::Matrix3d& dC_dF);

}  // namespace pbs

// The paper's volume constraints, one per tet, linearised at rest: how many motions they leave, and how much of a given one. On linear tets
// they ask exactly what incompressibility asks of the displacements (div u = 0 in each), so they lock as P1 does as nu goes to 1/2.
//   const VolumeConstraints volumes(mesh, held);
//   volumes.dofs() - volumes.rank();           // independent motions that change no tet's volume
//   volumes.equilibrium(load_n, shear_pa);     // of an elastic body that keeps every volume
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <Eigen/SparseCore>

#include <vector>

namespace pbs {

class VolumeConstraints {
public:
    VolumeConstraints(const TetMesh& mesh, const std::vector<bool>& held);  // held: #V, the vertices that do not move

    int constraints() const { return static_cast<int>(gradients_.rows()); }
    int dofs() const { return static_cast<int>(gradients_.cols()); }  // of the vertices that are not held
    int rank() const;                                                 // by QR; seconds for some thousand tets

    // #T x dofs, row t: grad C_t / sqrt(V0_t) [m^(1/2)], so that gradients^T gradients is the integral of div phi_i div phi_j.
    const Eigen::SparseMatrix<double>& gradients() const { return gradients_; }

    // The motion that keeps every volume and is nearest to the given one, with equal weights for all vertices: the limit of projections
    // with unit masses. #V x 3.
    Positions nearest(const Positions& motion) const;

    // Displacement [m], #V x 3, of linear tets of this shear modulus [Pa] that keep every volume, under a load [N], #V x 3; at least three
    // vertices are held. By the method of multipliers.
    Positions equilibrium(const Positions& load_n, double shear_pa) const;

private:
    Eigen::VectorXd free_of(const Positions& at_vertices) const;
    Positions at_vertices(const Eigen::VectorXd& free) const;
    Eigen::SparseMatrix<double> shear_stiffness() const;  // of 1 Pa: the integral of 2 eps : eps

    TetMesh mesh_;
    std::vector<int> place_;  // of a vertex among the free ones, -1: held
    Eigen::SparseMatrix<double> gradients_;
};

}  // namespace pbs

// Springs between material points of the flesh and given targets: an energy sum_s k_s / 2 |x(p_s) - target_s|^2, where x(p_s) is
// interpolated by the element's own shape functions. A point outside every tet is left out.
#pragma once

#include "reference_fem/nodal_matrix.hpp"

#include <vector>

namespace reference_fem {

// Keeps what it needs of mesh and space.
class AttachedPoints {
public:
    // points [m], #S x 3; stiffness [N/m], #S.
    AttachedPoints(const pbs::TetMesh& mesh, const SimplexSpace& space, const pbs::Positions& points, const Eigen::VectorXd& stiffness);

    // Adds k N^T N to the stiffness matrix [N/m]; a spring couples nodes of one tet only, so the pattern stays.
    void add_to(SparseMatrix& matrix) const;

    // Adds k N^T (target - point) to the load [N], #dofs; targets [m], #S x 3.
    void add_load(const pbs::Positions& targets, Eigen::VectorXd& load) const;

    // Adds the same to a matrix whose blocks exist already.
    void add_to(NodalMatrix& matrix) const;

    // The energy [J]; targets [m], #S x 3, displacement [m], #dofs.
    double energy(const pbs::Positions& targets, const Eigen::VectorXd& displacement) const;
    // Adds the gradient of that energy, k N^T (point + displacement - target) [N], #dofs.
    void add_pull(const pbs::Positions& targets, const Eigen::VectorXd& displacement, Eigen::VectorXd& gradient) const;

    // The points [m] moved by a displacement [m], #dofs -> #S x 3; not a number for points that were left out.
    pbs::Positions moved(const Eigen::VectorXd& displacement) const;

    const std::vector<int>& tets() const { return tet_; }  // #S, -1: outside

private:
    pbs::Vec3 moved(Eigen::Index spring, const Eigen::VectorXd& displacement) const;
    void sum_tets();

    pbs::Positions points_;
    Eigen::VectorXd stiffness_;
    std::vector<int> tet_;
    Eigen::MatrixXi nodes_;   // nodes per tet x #S
    Eigen::MatrixXd shapes_;  // their shape functions at the point
    // k N^T N summed over the springs of each gripped tet, nodes per tet x nodes per tet: as stiff as any number of springs in it.
    struct GrippedTet {
        Eigen::VectorXi nodes;
        Eigen::MatrixXd stiffness;  // [N/m]
    };
    std::vector<GrippedTet> gripped_;
};

}  // namespace reference_fem

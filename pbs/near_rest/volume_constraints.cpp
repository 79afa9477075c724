#include "pbs/near_rest/volume_constraints.hpp"

#include "pbs/constraints/volume.hpp"
#include "pbs/geometry/tet_volume.hpp"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseQR>

namespace pbs {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

std::array<Vec3, 4> gradients_of(const TetMesh& mesh, Eigen::Index tet)
{
    const auto corner = [&](int c) -> Vec3 { return mesh.rest.row(mesh.tets(tet, c)); };
    return gradient(VolumeConstraint<double>{}, corner(0), corner(1), corner(2), corner(3));
}

}  // namespace

VolumeConstraints::VolumeConstraints(const TetMesh& mesh, const std::vector<bool>& held) : mesh_(mesh), place_(held.size(), -1)
{
    int free = 0;
    for (std::size_t v = 0; v < held.size(); ++v)
        if (!held[v]) place_[v] = free++;
    const Eigen::VectorXd volumes = tet_volumes(mesh.rest, mesh.tets);
    std::vector<Eigen::Triplet<double>> entries;
    for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t) {
        const std::array<Vec3, 4> gradients = gradients_of(mesh, t);
        for (int c = 0; c < 4; ++c)
            for (int axis = 0; axis < 3 && place_[mesh.tets(t, c)] >= 0; ++axis)
                entries.emplace_back(t, 3 * place_[mesh.tets(t, c)] + axis, gradients[c](axis) / std::sqrt(volumes(t)));
    }
    gradients_.resize(mesh.tets.rows(), 3 * free);
    gradients_.setFromTriplets(entries.begin(), entries.end());
}

int VolumeConstraints::rank() const
{
    // The constraints are the columns; pivoting finds those that depend on the others.
    Eigen::SparseQR<Sparse, Eigen::COLAMDOrdering<int>> qr;
    qr.setPivotThreshold(1e-10);
    Sparse columns = gradients_.transpose();
    columns.makeCompressed();
    qr.compute(columns);
    return static_cast<int>(qr.rank());
}

Positions VolumeConstraints::nearest(const Positions& motion) const
{
    // u - G^T y with G (u - G^T y) = 0.
    const Sparse transposed = gradients_.transpose();
    Eigen::LeastSquaresConjugateGradient<Sparse> least_squares;
    least_squares.setTolerance(1e-13);
    least_squares.setMaxIterations(20 * gradients_.cols());
    least_squares.compute(transposed);
    const Eigen::VectorXd u = free_of(motion);
    return at_vertices(u - transposed * least_squares.solve(u));
}

Positions VolumeConstraints::equilibrium(const Positions& load_n, double shear_pa) const
{
    const double penalty = 1e4;  // relative to the shear modulus: large enough to converge in a few rounds, small enough to keep digits
    const Sparse matrix = shear_stiffness() + penalty * Sparse(gradients_.transpose() * gradients_);
    const Eigen::SimplicialLDLT<Sparse> factor(matrix);
    const Eigen::VectorXd load = free_of(load_n) / shear_pa;
    Eigen::VectorXd pressure = Eigen::VectorXd::Zero(gradients_.rows()), u = factor.solve(load);
    const double first = (gradients_ * u).norm();
    for (int round = 0; round < 20 && (gradients_ * u).norm() > 1e-9 * first; ++round) {
        pressure += penalty * (gradients_ * u);
        u = factor.solve(load - gradients_.transpose() * pressure);
    }
    return at_vertices(u);
}

Sparse VolumeConstraints::shear_stiffness() const
{
    const Eigen::VectorXd volumes = tet_volumes(mesh_.rest, mesh_.tets);
    std::vector<Eigen::Triplet<double>> entries;
    for (Eigen::Index t = 0; t < mesh_.tets.rows(); ++t) {
        const std::array<Vec3, 4> g = gradients_of(mesh_, t);  // of a shape function, times the volume
        for (int a = 0; a < 4; ++a)
            for (int b = 0; b < 4; ++b) {
                const int row = place_[mesh_.tets(t, a)], column = place_[mesh_.tets(t, b)];
                if (row < 0 || column < 0) continue;
                const Eigen::Matrix3d block = (g[a].dot(g[b]) * Eigen::Matrix3d::Identity() + g[b] * g[a].transpose()) / volumes(t);
                for (int i = 0; i < 3; ++i)
                    for (int j = 0; j < 3; ++j) entries.emplace_back(3 * row + i, 3 * column + j, block(i, j));
            }
    }
    Sparse stiffness(dofs(), dofs());
    stiffness.setFromTriplets(entries.begin(), entries.end());
    return stiffness;
}

Eigen::VectorXd VolumeConstraints::free_of(const Positions& at_vertices) const
{
    Eigen::VectorXd free(dofs());
    for (std::size_t v = 0; v < place_.size(); ++v)
        if (place_[v] >= 0) free.segment<3>(3 * place_[v]) = at_vertices.row(v).transpose();
    return free;
}

Positions VolumeConstraints::at_vertices(const Eigen::VectorXd& free) const
{
    Positions positions = Positions::Zero(mesh_.rest.rows(), 3);
    for (std::size_t v = 0; v < place_.size(); ++v)
        if (place_[v] >= 0) positions.row(v) = free.segment<3>(3 * place_[v]).transpose();
    return positions;
}

}  // namespace pbs

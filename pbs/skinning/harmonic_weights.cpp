#include "pbs/skinning/weights.hpp"

#include <Eigen/SparseCholesky>

namespace pbs {
namespace {

constexpr double negligible = 1e-6;
constexpr double regular = 1e-9;  // keeps the system of a part that nothing grips from being singular; its weights become 0

using Laplacian = Eigen::SparseMatrix<double>;
using Gradients = Eigen::Matrix<double, 3, 4>;

// Gradients of the four barycentric coordinates [1/m], one per column, and the tet's volume [m^3].
Gradients barycentric_gradients(const TetMesh& mesh, Eigen::Index tet, double& volume_m3)
{
    Eigen::Matrix3d edges;
    for (int k = 0; k < 3; ++k) edges.row(k) = mesh.rest.row(mesh.tets(tet, k + 1)) - mesh.rest.row(mesh.tets(tet, 0));
    volume_m3 = edges.determinant() / 6.0;
    Gradients gradients;
    gradients.rightCols<3>() = edges.inverse();
    gradients.col(0) = -gradients.rightCols<3>().rowwise().sum();
    return gradients;
}

// The rows of known vertices are those of the identity; their couplings go to the right-hand side.
Laplacian held_laplacian(const TetMesh& mesh, const std::vector<bool>& known, const Eigen::MatrixXd& weights,
                         Eigen::MatrixXd& right_hand_sides)
{
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t v = 0; v < known.size(); ++v) {
        if (!known[v]) continue;
        entries.emplace_back(v, v, 1.0);
        right_hand_sides.row(static_cast<Eigen::Index>(v)) = weights.row(static_cast<Eigen::Index>(v));
    }
    for (Eigen::Index tet = 0; tet < mesh.tets.rows(); ++tet) {
        double volume_m3 = 0.0;
        const Gradients gradients = barycentric_gradients(mesh, tet, volume_m3);
        for (int a = 0; a < 4; ++a)
            for (int b = 0; b < 4; ++b) {
                const int row = mesh.tets(tet, a), column = mesh.tets(tet, b);
                if (known[row]) continue;
                const double entry = volume_m3 * gradients.col(a).dot(gradients.col(b));
                if (known[column])
                    right_hand_sides.row(row) -= entry * weights.row(column);
                else
                    entries.emplace_back(row, column, row == column ? (1.0 + regular) * entry : entry);
            }
    }
    Laplacian laplacian(mesh.rest.rows(), mesh.rest.rows());
    laplacian.setFromTriplets(entries.begin(), entries.end());
    return laplacian;
}

Weights sparse(const Eigen::MatrixXd& weights)
{
    Weights result;
    result.first.push_back(0);
    for (Eigen::Index v = 0; v < weights.rows(); ++v) {
        const double sum = (weights.row(v).array() > negligible).select(weights.row(v), 0.0).sum();
        for (int j = 0; j < weights.cols(); ++j) {
            if (!(weights(v, j) > negligible)) continue;
            result.bone.push_back(j);
            result.weight.push_back(weights(v, j) / sum);
        }
        if (result.first.back() == static_cast<int>(result.bone.size())) {
            result.bone.push_back(0);
            result.weight.push_back(1.0);
        }
        result.first.push_back(static_cast<int>(result.bone.size()));
    }
    return result;
}

}  // namespace

Weights harmonic_extension(const TetMesh& mesh, const std::vector<bool>& known, const Eigen::MatrixXd& weights)
{
    Eigen::MatrixXd right_hand_sides = Eigen::MatrixXd::Zero(weights.rows(), weights.cols());
    const Laplacian laplacian = held_laplacian(mesh, known, weights, right_hand_sides);
    const Eigen::SimplicialLDLT<Laplacian> factor(laplacian);
    return sparse(factor.solve(right_hand_sides));
}

Weights harmonic_weights(const TetMesh& mesh, const std::vector<int>& gripping_bone, int bones)
{
    std::vector<bool> gripped;
    Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(mesh.rest.rows(), bones);
    for (std::size_t v = 0; v < gripping_bone.size(); ++v) {
        gripped.push_back(gripping_bone[v] >= 0);
        if (gripped.back()) weights(static_cast<Eigen::Index>(v), gripping_bone[v]) = 1.0;
    }
    return harmonic_extension(mesh, gripped, weights);
}

}  // namespace pbs

#include "experiments/deformers/delta_mush/delta_mush.hpp"

#include "pbs/geometry/topology.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>

#include <limits>

namespace experiments {

DeltaMush::DeltaMush(const pbs::TetMesh& mesh, const DeltaMushOptions& options) : options_(options), first_(mesh.rest.rows() + 1, 0)
{
    const pbs::Edges edges = pbs::edges_of(mesh.tets);
    for (const int vertex : edges.reshaped()) ++first_[vertex + 1];
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    neighbour_.resize(2 * edges.rows());
    std::vector<int> next(first_.begin(), first_.end() - 1);
    for (const auto edge : edges.rowwise()) {
        neighbour_[next[edge(0)]++] = edge(1);
        neighbour_[next[edge(1)]++] = edge(0);
    }
    smoothed_rest_ = smoothed(mesh.rest);
    delta_ = mesh.rest - smoothed_rest_;
}

void DeltaMush::apply(const pbs::Positions& blended, pbs::Positions& posed) const
{
    const pbs::Positions smooth = smoothed(blended);
    posed.resize(blended.rows(), 3);
    for (int i = 0; i < blended.rows(); ++i) posed.row(i) = smooth.row(i) + (rotation(smooth, i) * delta_.row(i).transpose()).transpose();
}

pbs::Positions DeltaMush::smoothed(pbs::Positions positions) const
{
    pbs::Positions next = positions;
    for (int iteration = 0; iteration < options_.iterations; ++iteration) {
        for (Eigen::Index i = 0; i < positions.rows(); ++i) {
            if (first_[i] == first_[i + 1]) continue;
            Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
            for (int k = first_[i]; k < first_[i + 1]; ++k) sum += positions.row(neighbour_[k]);
            next.row(i) = positions.row(i) + options_.step * (sum / (first_[i + 1] - first_[i]) - positions.row(i));
        }
        positions.swap(next);
    }
    return positions;
}

// The rotation nearest to the sum over the neighbours of (posed edge) (rest edge)^T.
Eigen::Matrix3d DeltaMush::rotation(const pbs::Positions& smoothed_posed, int vertex) const
{
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (int k = first_[vertex]; k < first_[vertex + 1]; ++k)
        covariance += (smoothed_posed.row(neighbour_[k]) - smoothed_posed.row(vertex)).transpose() *
                      (smoothed_rest_.row(neighbour_[k]) - smoothed_rest_.row(vertex));
    if (!covariance.allFinite()) return Eigen::Matrix3d::Constant(std::numeric_limits<double>::quiet_NaN());
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Matrix3d u = svd.matrixU();
    if ((u * svd.matrixV().transpose()).determinant() < 0.0) u.col(2) *= -1.0;
    return u * svd.matrixV().transpose();
}

}  // namespace experiments

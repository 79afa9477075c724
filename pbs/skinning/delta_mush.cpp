#include "pbs/skinning/delta_mush.hpp"

#include "pbs/geometry/nearest_rotation.hpp"

namespace pbs {

DeltaMush::DeltaMush(const TetMesh& mesh, const DeltaMushOptions& options)
    : options_(options), neighbours_(adjacency_of(mesh.tets, static_cast<int>(mesh.rest.rows())))
{
    smoothed_rest_ = smoothed(mesh.rest);
    delta_ = mesh.rest - smoothed_rest_;
}

void DeltaMush::apply(const Positions& blended, Positions& posed) const
{
    const Positions smooth = smoothed(blended);
    posed.resize(blended.rows(), 3);
    for (int i = 0; i < blended.rows(); ++i) posed.row(i) = smooth.row(i) + (rotation(smooth, i) * delta_.row(i).transpose()).transpose();
}

Positions DeltaMush::smoothed(Positions positions) const
{
    Positions next = positions;
    for (int iteration = 0; iteration < options_.iterations; ++iteration) {
        for (Eigen::Index i = 0; i < positions.rows(); ++i) {
            if (neighbours_.first[i] == neighbours_.first[i + 1]) continue;
            Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
            for (int k = neighbours_.first[i]; k < neighbours_.first[i + 1]; ++k) sum += positions.row(neighbours_.neighbour[k]);
            next.row(i) = positions.row(i) + options_.step * (sum / (neighbours_.first[i + 1] - neighbours_.first[i]) - positions.row(i));
        }
        positions.swap(next);
    }
    return positions;
}

// The rotation nearest to the sum over the neighbours of (posed edge) (rest edge)^T.
Eigen::Matrix3d DeltaMush::rotation(const Positions& smoothed_posed, int vertex) const
{
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (int k = neighbours_.first[vertex]; k < neighbours_.first[vertex + 1]; ++k)
        covariance += (smoothed_posed.row(neighbours_.neighbour[k]) - smoothed_posed.row(vertex)).transpose() *
                      (smoothed_rest_.row(neighbours_.neighbour[k]) - smoothed_rest_.row(vertex));
    return nearest_rotation(covariance);
}

}  // namespace pbs

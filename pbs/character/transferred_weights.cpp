#include "pbs/character/transferred_weights.hpp"

#include "pbs/character/nearest_triangle.hpp"
#include "pbs/geometry/topology.hpp"
#include "pbs/skinning/harmonic_weights.hpp"

#include <algorithm>

namespace pbs {

TransferredWeights transfer_weights(const TetMesh& mesh, const Positions& surface, const Triangles& triangles, const Weights& skin,
                                    int bones)
{
    const SurfaceTree tree(surface, triangles);
    const std::vector<bool> on_boundary = boundary_vertices(mesh.tets, mesh.rest.rows());
    Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(mesh.rest.rows(), bones);
    TransferredWeights transferred;
    for (Eigen::Index v = 0; v < mesh.rest.rows(); ++v) {
        if (!on_boundary[static_cast<std::size_t>(v)]) continue;
        const SurfacePoint nearest = tree.nearest(mesh.rest.row(v).transpose());
        transferred.largest_distance_m = std::max(transferred.largest_distance_m, nearest.distance_m);
        for (int corner = 0; corner < 3; ++corner) {
            const int point = triangles(nearest.triangle, corner);
            for (int e = skin.first[point]; e < skin.first[point + 1]; ++e)
                weights(v, skin.bone[e]) += nearest.barycentric(corner) * skin.weight[e];
        }
    }
    transferred.weights = harmonic_extension(mesh, on_boundary, weights);
    return transferred;
}

}  // namespace pbs

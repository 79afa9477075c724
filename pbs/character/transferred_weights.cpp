#include "pbs/character/transferred_weights.hpp"

#include "pbs/character/nearest_triangle.hpp"
#include "pbs/geometry/topology.hpp"
#include "pbs/skinning/weights.hpp"

#include <algorithm>
#include <map>
#include <numeric>

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

CarriedWeight carried_weight(const Weights& skin, const Weights& in_tets, const EmbeddedSurface& surface, const Tets& tets, int bones)
{
    CarriedWeight weight{std::vector<double>(bones, 0.0), std::vector<double>(bones, 0.0)};
    for (int point = 0; point < skin.vertices(); ++point) {
        std::map<int, double> of_tets;
        for (int corner = 0; corner < 4; ++corner) {
            const int v = tets(surface.tet(point), corner);
            for (int e = in_tets.first[v]; e < in_tets.first[v + 1]; ++e)
                of_tets[in_tets.bone[e]] += surface.barycentric(point, corner) * in_tets.weight[e];
        }
        for (int e = skin.first[point]; e < skin.first[point + 1]; ++e) {
            weight.of_artist[skin.bone[e]] += skin.weight[e];
            weight.carried[skin.bone[e]] += std::clamp(of_tets[skin.bone[e]], 0.0, skin.weight[e]);
        }
    }
    return weight;
}

double CarriedWeight::share_pct() const
{
    const double whole = std::accumulate(of_artist.begin(), of_artist.end(), 0.0);
    return whole > 0.0 ? 100.0 * std::accumulate(carried.begin(), carried.end(), 0.0) / whole : 0.0;
}

}  // namespace pbs

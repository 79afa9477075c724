#include "pbs/flesh/vbd.hpp"

#include <algorithm>

namespace pbs {
namespace {

// The edge between two corners, as its number in 01 02 03 12 13 23.
constexpr int edge_between[4][4] = {{-1, 0, 1, 2}, {0, -1, 3, 4}, {1, 3, -1, 5}, {2, 4, 5, -1}};
// The other corners, so that n points to the corner where V > 0.
constexpr int others_of_corner[4][3] = {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}};

}  // namespace

std::vector<VertexStar> vertex_stars(const FleshEnergy& energy)
{
    std::vector<VertexStar> stars(energy.hold().size());
    for (std::size_t i = 0; i < stars.size(); ++i) stars[i].hold = stars[i].diagonal = energy.hold()(i);
    for (const FleshTet& tet : energy.tets())
        for (int corner = 0; corner < 4; ++corner) {
            IncidentTet incident{{}, {}, tet.kappa, tet.d};
            VertexStar& star = stars[tet.vertex[corner]];
            for (int k = 0; k < 3; ++k) {
                const int other = others_of_corner[corner][k];
                incident.other[k] = tet.vertex[other];
                incident.w[k] = tet.w[edge_between[corner][other]];
                star.diagonal += incident.w[k];
            }
            star.tets.push_back(incident);
        }
    return stars;
}

VertexBlock vertex_block(const VertexStar& star, int vertex, const Positions& x, const Positions& centres)
{
    const Vec3 x_i = x.row(vertex);
    VertexBlock block{star.hold * (x_i - centres.row(vertex).transpose()), star.diagonal * Eigen::Matrix3d::Identity(), star.diagonal};
    for (const IncidentTet& tet : star.tets) {
        Vec3 to[3];
        for (int k = 0; k < 3; ++k) {
            to[k] = x.row(tet.other[k]).transpose() - x_i;
            block.gradient -= tet.w[k] * to[k];
        }
        const Vec3 n = (to[1] - to[0]).cross(to[2] - to[0]);
        const double six_volumes = -n.dot(to[0]);
        block.gradient += tet.kappa * (six_volumes - tet.d) * n;
        block.hessian += tet.kappa * n * n.transpose();
    }
    return block;
}

Vec3 block_step(const VertexBlock& block)
{
    if (!(block.diagonal > 0.0)) return Vec3::Zero();
    const Eigen::Matrix3d& h = block.hessian;
    const Vec3& g = block.gradient;
    const double d0 = h(0, 0), l10 = h(1, 0) / d0, l20 = h(2, 0) / d0;
    const double d1 = std::max(h(1, 1) - l10 * h(1, 0), block.diagonal);
    const double below = h(2, 1) - l20 * h(1, 0), l21 = below / d1;
    const double d2 = std::max(h(2, 2) - l20 * h(2, 0) - l21 * below, block.diagonal);
    const double y1 = g(1) - l10 * g(0), y2 = g(2) - l20 * g(0) - l21 * y1;
    const double s2 = y2 / d2, s1 = y1 / d1 - l21 * s2, s0 = g(0) / d0 - l10 * s1 - l20 * s2;
    return {s0, s1, s2};
}

}  // namespace pbs

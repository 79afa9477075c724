#include "experiments/studies/equal_quality/tapered_limb.hpp"

#include "pbs/geometry/tet_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace experiments {
namespace {

constexpr int layers = 25, across = 9;
constexpr double half_length = 1.0, first_radius = 0.24, last_radius = 0.12;  // [m]

int vertex(const std::array<int, 3>& at)
{
    return (at[0] * across + at[1]) * across + at[2];
}

// The square [-1, 1]^2 becomes a disc of radius one: (u sqrt(1 - v^2 / 2), v sqrt(1 - u^2 / 2)).
pbs::Positions grid_points()
{
    pbs::Positions points(layers * across * across, 3);
    for (int i = 0; i < layers; ++i)
        for (int j = 0; j < across; ++j)
            for (int k = 0; k < across; ++k) {
                const double along = double(i) / (layers - 1), u = 2.0 * j / (across - 1) - 1.0, v = 2.0 * k / (across - 1) - 1.0;
                const double radius = std::lerp(first_radius, last_radius, along);
                points.row(vertex({i, j, k})) << half_length * (2.0 * along - 1.0), radius * u * std::sqrt(1.0 - v * v / 2.0),
                    radius * v * std::sqrt(1.0 - u * u / 2.0);
            }
    return points;
}

// Each of the six tets of a cube follows a path along the axes, in one of their orders, from the first corner to the last.
pbs::Tets grid_tets(const pbs::Positions& points)
{
    pbs::Tets tets(6 * (layers - 1) * (across - 1) * (across - 1), 4);
    Eigen::Index t = 0;
    for (int i = 0; i + 1 < layers; ++i)
        for (int j = 0; j + 1 < across; ++j)
            for (int k = 0; k + 1 < across; ++k) {
                std::array<int, 3> axes = {0, 1, 2};
                do {
                    std::array<int, 3> corner = {i, j, k};
                    tets(t, 0) = vertex(corner);
                    for (int step = 0; step < 3; ++step) {
                        ++corner[axes[step]];
                        tets(t, step + 1) = vertex(corner);
                    }
                    ++t;
                } while (std::next_permutation(axes.begin(), axes.end()));
            }
    const Eigen::VectorXd volumes = pbs::tet_volumes(points, tets);
    for (t = 0; t < tets.rows(); ++t)
        if (volumes(t) < 0.0) std::swap(tets(t, 2), tets(t, 3));
    return tets;
}

}  // namespace

pbs::Character tapered_limb()
{
    pbs::Character limb;
    limb.name = "tapered_limb";
    limb.mesh.rest = grid_points();
    limb.mesh.tets = grid_tets(limb.mesh.rest);
    const pbs::Vec3 end(half_length, 0.0, 0.0);
    limb.skeleton = {{{"upper", -1, -end, pbs::Vec3::Zero()}, {"forearm", 0, pbs::Vec3::Zero(), end}}};
    limb.binding = pbs::bind_to_nearest_bone(limb.mesh.rest, limb.skeleton);
    limb.weights = pbs::paper_weights(limb.binding, limb.skeleton);
    for (int i = 0; i < limb.weights.vertices(); ++i) limb.blended.push_back(limb.weights.blended(i));
    return limb;
}

}  // namespace experiments

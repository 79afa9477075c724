#include "experiments/studies/stability/distorted_mesh.hpp"

#include "pbs/geometry/tet_mesh.hpp"

#include <Eigen/Geometry>

#include <numeric>
#include <random>

namespace experiments {
namespace {

constexpr double share_of_vertices = 0.05;

std::vector<std::vector<int>> tets_around(const pbs::TetMesh& mesh)
{
    std::vector<std::vector<int>> around(mesh.rest.rows());
    for (int t = 0; t < mesh.tets.rows(); ++t)
        for (const int v : mesh.tets.row(t)) around[v].push_back(t);
    return around;
}

// The new place of the vertex: closer to the plane of the tet's other three corners, or closer to one of them.
pbs::Vec3 moved(const pbs::TetMesh& mesh, int vertex, int tet, Defect defect, double thinness)
{
    std::vector<pbs::Vec3> others;
    for (const int v : mesh.tets.row(tet))
        if (v != vertex) others.push_back(mesh.rest.row(v));
    const pbs::Vec3 p = mesh.rest.row(vertex);
    if (defect == Defect::needles) return others[0] + thinness * (p - others[0]);
    const pbs::Vec3 normal = (others[1] - others[0]).cross(others[2] - others[0]).normalized();
    return p - (1.0 - thinness) * normal.dot(p - others[0]) * normal;
}

bool all_upright(const pbs::TetMesh& mesh, const std::vector<int>& tets)
{
    for (const int t : tets) {
        const auto corner = [&](int c) -> pbs::Vec3 { return mesh.rest.row(mesh.tets(t, c)); };
        if (!(pbs::tet_volume(corner(0), corner(1), corner(2), corner(3)) > 0.0)) return false;
    }
    return true;
}

}  // namespace

pbs::TetMesh distorted(const pbs::TetMesh& mesh, Defect defect, double thinness)
{
    if (defect == Defect::none) return mesh;
    pbs::TetMesh spoilt = mesh;
    const auto around = tets_around(mesh);
    std::vector<int> order(mesh.rest.rows());
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), std::mt19937(stability_seed));
    std::vector<bool> touched(mesh.rest.rows(), false);
    int wanted = static_cast<int>(share_of_vertices * static_cast<double>(mesh.rest.rows()));
    for (const int vertex : order) {
        if (wanted == 0) break;
        if (touched[vertex]) continue;
        for (const int tet : around[vertex]) {
            const pbs::Vec3 before = spoilt.rest.row(vertex);
            spoilt.rest.row(vertex) = moved(spoilt, vertex, tet, defect, thinness);
            if (all_upright(spoilt, around[vertex])) {
                for (const int t : around[vertex])
                    for (const int v : mesh.tets.row(t)) touched[v] = true;
                --wanted;
                break;
            }
            spoilt.rest.row(vertex) = before;
        }
    }
    return spoilt;
}

}  // namespace experiments

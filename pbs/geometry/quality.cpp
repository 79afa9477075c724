#include "pbs/geometry/quality.hpp"

#include "pbs/geometry/tet_volume.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <limits>
#include <numbers>
#include <sstream>

namespace pbs {
namespace {

// The six edges of a tet, each with the two corners that are not on it.
constexpr std::array<std::array<int, 4>, 6> edge_corners = {
    {{0, 1, 2, 3}, {0, 2, 1, 3}, {0, 3, 1, 2}, {1, 2, 0, 3}, {1, 3, 0, 2}, {2, 3, 0, 1}}};

void examine_dihedrals(const TetMesh& mesh, Quality& quality)
{
    quality.min_dihedral_deg = 180.0;
    for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t) {
        const std::array<double, 6> angles_deg = dihedral_angles_deg(mesh.rest.row(mesh.tets(t, 0)), mesh.rest.row(mesh.tets(t, 1)),
                                                                     mesh.rest.row(mesh.tets(t, 2)), mesh.rest.row(mesh.tets(t, 3)));
        const auto [smallest, largest] = std::minmax_element(angles_deg.begin(), angles_deg.end());
        quality.min_dihedral_deg = std::min(quality.min_dihedral_deg, *smallest);
        quality.max_dihedral_deg = std::max(quality.max_dihedral_deg, *largest);
    }
}

void examine_edges(const TetMesh& mesh, Quality& quality)
{
    const Edges edges = edges_of(mesh.tets);
    quality.edges = static_cast<int>(edges.rows());
    quality.shortest_edge_m = std::numeric_limits<double>::infinity();
    for (Eigen::Index e = 0; e < edges.rows(); ++e) {
        const double length = (mesh.rest.row(edges(e, 0)) - mesh.rest.row(edges(e, 1))).norm();
        quality.shortest_edge_m = std::min(quality.shortest_edge_m, length);
        quality.longest_edge_m = std::max(quality.longest_edge_m, length);
    }
}

}  // namespace

std::array<double, 6> dihedral_angles_deg(const Vec3& p1, const Vec3& p2, const Vec3& p3, const Vec3& p4)
{
    const std::array<const Vec3*, 4> corner = {&p1, &p2, &p3, &p4};
    std::array<double, 6> angles_deg;
    for (std::size_t e = 0; e < edge_corners.size(); ++e) {
        const auto [a, b, c, d] = edge_corners[e];
        const Vec3 edge = *corner[b] - *corner[a];
        const Vec3 normal_c = edge.cross(*corner[c] - *corner[a]), normal_d = edge.cross(*corner[d] - *corner[a]);
        angles_deg[e] = std::atan2(normal_c.cross(normal_d).norm(), normal_c.dot(normal_d)) * 180.0 / std::numbers::pi;
    }
    return angles_deg;
}

Quality quality_of(const TetMesh& mesh)
{
    Quality quality;
    quality.vertices = static_cast<int>(mesh.rest.rows());
    quality.tets = static_cast<int>(mesh.tets.rows());
    quality.topology = topology_of(mesh.tets, mesh.rest.rows());
    if (quality.tets == 0) return quality;

    const Triangles boundary = boundary_of(mesh.tets);
    std::vector<bool> on_boundary(mesh.rest.rows(), false);
    for (const int vertex : boundary.reshaped()) on_boundary[vertex] = true;
    quality.boundary_triangles = static_cast<int>(boundary.rows());
    quality.boundary_vertices = static_cast<int>(std::count(on_boundary.begin(), on_boundary.end(), true));
    quality.volume_m3 = tet_volumes(mesh.rest, mesh.tets).sum();
    examine_dihedrals(mesh, quality);
    examine_edges(mesh, quality);
    return quality;
}

std::string describe(const Quality& quality)
{
    const Topology& topology = quality.topology;
    std::ostringstream text;
    text << quality.vertices << " vertices (" << quality.boundary_vertices << " on the boundary), " << quality.edges << " edges, "
         << quality.tets << " tets, " << quality.boundary_triangles << " boundary triangles\n";
    text << std::setprecision(6) << "volume " << quality.volume_m3 << " m^3, edges " << std::setprecision(3) << quality.shortest_edge_m
         << " to " << quality.longest_edge_m << " m, dihedral angles " << std::fixed << std::setprecision(1) << quality.min_dihedral_deg
         << " to " << quality.max_dihedral_deg << " deg\n";
    text << "boundary " << (topology.boundary_manifold ? "manifold" : "NOT manifold") << ", " << topology.boundary_components
         << " component(s), Euler characteristic " << topology.boundary_euler << "; " << topology.components << " component(s) of tets, "
         << topology.unused_vertices << " unused vertices\n";
    return text.str();
}

}  // namespace pbs

#include "pbs/geometry/meshing_verdict.hpp"

#include "pbs/geometry/quality.hpp"

#include <algorithm>
#include <cmath>

namespace pbs {

std::string breach_of(const TetMesh& mesh, const SurfaceMeshing& options)
{
    if (mesh.tets.rows() == 0) return "no tets";
    const Quality quality = quality_of(mesh);
    if (!quality.topology.boundary_manifold) return "the boundary is not manifold";
    if (quality.topology.components != 1) return std::to_string(quality.topology.components) + " pieces";
    if (quality.topology.boundary_euler != options.boundary_euler)
        return "Euler number of the boundary " + std::to_string(quality.topology.boundary_euler) + ", expected " +
               std::to_string(options.boundary_euler);
    if (quality.min_dihedral_deg < options.min_dihedral_deg)
        return "smallest dihedral angle " + std::to_string(quality.min_dihedral_deg) + " deg";

    const Triangles boundary = boundary_of(mesh.tets);
    if (self_intersects(mesh.rest, boundary)) return "the boundary intersects itself";
    if (options.inside.empty()) return "";
    const std::vector<bool> inside = points_inside(mesh.rest, boundary, options.inside);
    const auto outside = std::count(inside.begin(), inside.end(), false);
    if (outside == 0) return "";
    const auto first = std::find(inside.begin(), inside.end(), false) - inside.begin();
    return std::to_string(outside) + " of the points asked inside are outside, the first is number " + std::to_string(first);
}

}  // namespace pbs

// Tet meshes of the built-in bodies and of surfaces, by CGAL (Mesh_3, alpha_wrap_3).
#pragma once

#include "pbs/geometry/mesh_io.hpp"

namespace pbs {

// Limb: capsule of radius 0.15 m round (-1,0,0) -> (1,0,0) m with round caps. Bar: [-1, 1] x [-0.15, 0.15]^2 m.
// `vertices`: wanted number; what comes out is within some 10 % (the cell size is searched).
TetMesh mesh_limb(int vertices);
TetMesh mesh_bar(int vertices);

// A closed or nearly closed surface [m] -> tets of about the wanted number of vertices: wrapped (alpha_wrap_3), meshed with a cell
// size proportional to the local thickness, perturbed and exuded, checked, tried again with another facet distance where the check fails.
struct SurfaceMeshing {
    int vertices = 2000;
    double wrap_alpha_m = 0.0;      // 0: from the size of the body
    double wrap_offset_m = 0.0;     // 0: alpha / 3
    double min_dihedral_deg = 5.0;  // asked of every tet
    std::vector<Vec3> inside;       // points that must lie inside, e.g. joints
};
TetMesh mesh_surface(const SurfaceMesh& surface, const SurfaceMeshing& options);

// The boundary triangles intersect each other somewhere, neighbours aside.
bool self_intersects(const Positions& positions, const Triangles& boundary);

}  // namespace pbs

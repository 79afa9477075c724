// Separate shells of a surface that are too thin for the tets, such as whiskers and whips.
//   const ThickShells thick = thick_shells(surface, 2000);   // thick.triangles: the surface without them
#pragma once

#include "experiments/meshes/meshing.hpp"

namespace pbs {

// The triangles [#F x 3] of a surface without its thin shells. A shell is thin if four times its volume over its area,
// which is the diameter of a long cylinder and twice the thickness of a plate, is below the edge of tets with so many
// vertices in the surface's volume. The shell with the largest volume stays.
struct ThickShells {
    Triangles triangles;
    int left_out = 0;  // shells
};
ThickShells thick_shells(const SurfaceMesh& surface, int vertices);

// The surface of these triangles without the points that none of them uses; the others keep their order.
SurfaceMesh used_part(const SurfaceMesh& surface);

}  // namespace pbs

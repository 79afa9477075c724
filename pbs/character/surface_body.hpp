// A character from a closed surface and a skeleton: tets from the cache, or made; the surface carried along where it is wanted.
#pragma once

#include "pbs/character/character.hpp"
#include "pbs/geometry/mesh_io.hpp"

#include <functional>
#include <string>

namespace pbs {

struct SurfaceBody {
    std::string name;
    std::string made_from = {};                 // content hashes of what surface and skeleton come from
    Skeleton skeleton = {};                     // [m]
    std::function<SurfaceMesh()> surface = {};  // [m]; asked for only where it is needed
    int boundary_euler = 2;                     // 0: a body with one handle
    std::vector<Vec3> inside = {};              // must lie inside the tets; where empty: the heads of all bones
};

Character make_surface_body(const SurfaceBody& body, int vertices, bool with_surface);

}  // namespace pbs

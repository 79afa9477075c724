// A character from a closed surface and a skeleton: tets from the cache, or made; the surface carried along where it is wanted.
#pragma once

#include "pbs/character/character.hpp"
#include "pbs/geometry/mesh_io.hpp"

#include <functional>
#include <string>

namespace pbs {

// made_from, the name and the number of vertices are the key by which tets are cached: the same ones mean the same tets.
struct SurfaceBody {
    std::string name;                           // of the character, and the beginning of its file in the cache
    std::string made_from = {};                 // content hashes of what surface and skeleton come from
    Skeleton skeleton = {};                     // [m]
    std::function<SurfaceMesh()> surface = {};  // [m]; called only where it is needed
    int boundary_euler = 2;                     // 0: a body with one handle
    std::vector<Vec3> inside = {};              // must lie inside the tets; where empty: the heads of all bones
    bool is_foreign = false;                    // of a file that nobody here made: any handles and parts, joints may be outside
};

// vertices: wanted, as of mesh_surface, whose InputErrors reach the caller. Binding and weights are left empty, for make_character to fill.
Character make_surface_body(const SurfaceBody& body, int vertices, bool with_surface);

}  // namespace pbs

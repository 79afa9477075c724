// The polygons of an FBX mesh and the triangles that they are split into.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <vector>

namespace pbs {

struct FbxPolygons {
    std::vector<int> corners;          // the point of each corner
    std::vector<std::size_t> ends;     // one behind the last corner of each polygon
    std::vector<int> triangles;        // three corners each
    std::vector<std::size_t> polygon;  // of each triangle
};

// Fills the triangles by cutting off ears of the polygon's projection along its normal. A polygon whose projection has
// none, since its edges cross, is split into a fan; those of fewer than three corners have no triangle. points: #P x 3.
void triangulate(const Positions& points, FbxPolygons& polygons);

}  // namespace pbs

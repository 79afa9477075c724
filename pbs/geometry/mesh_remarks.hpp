// What is accepted in a mesh although its author may not have meant it, and what is made of it: one line each, to be told to the user.
//   for (const std::string& remark : remarks_on("arm.msh", read_tet_mesh("arm.msh"))) ...
#pragma once

#include "pbs/geometry/mesh_io.hpp"

namespace pbs {

// Turned tets, parts that no face joins, and a size that speaks for other units than metres (under 1 mm or above 100 m).
std::vector<std::string> remarks_on(const std::string& path, const MeshReading& reading);

// read_surface of a file that a user names, with its remarks: points that no triangle uses, triangles that are a line or a point, holes,
// triangles that cross (asked in builds with CGAL), a surface inside out, and the size as above. An edge in three triangles is an
// InputError.
SurfaceMesh read_surface(const std::string& path, std::vector<std::string>& remarks);

// For readers: on a surface as it was joined, and what was left out of it.
std::vector<std::string> remarks_on(const std::string& path, const SurfaceMesh& surface, int unused_points, int triangles_without_area);

}  // namespace pbs

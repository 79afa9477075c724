// Remarks on properties of a mesh that are accepted although its author may not have intended them: one line each, printed for the user.
//   for (const std::string& remark : remarks_on("arm.msh", read_tet_mesh("arm.msh"))) ...
#pragma once

#include "pbs/geometry/mesh_io.hpp"

namespace pbs {

// A name that does not fit the content, turned tets, vertices that were left out or split, parts that no face joins, and a size that speaks
// for other units than metres (under 1 mm or above 100 m).
std::vector<std::string> remarks_on(const std::string& path, const MeshReading& reading);

// read_surface of a file that a user names, with its remarks: a name that does not fit the content, points that no triangle uses, triangles
// that are a line or a point, holes, edges in three triangles or more, triangles that cross (checked in builds with CGAL), a surface inside
// out, and the size as above.
SurfaceMesh read_surface(const std::string& path, std::vector<std::string>& remarks, double scale = 1.0);

// On a file whose content has the format of files with another extension.
std::string remark_on_name(const std::string& path, const std::string& content_extension);

// For readers: remarks on a surface after its points were joined, and on what was left out of it.
std::vector<std::string> remarks_on(const std::string& path, const SurfaceMesh& surface, int unused_points, int triangles_without_area);

}  // namespace pbs

// Surfaces of any format. experiments/meshes reads .obj, .ply, .off, .stl and .vtp, and the readers of rigs read .gltf,
// .glb, .dae, .zae and .fbx. The content chooses the reader if it shows the format, otherwise the extension does.
//   const SurfaceMesh body = read_surface("body.fbx");
#pragma once

#include "experiments/meshes/mesh_io.hpp"

#include <string>
#include <vector>

namespace pbs {

// The result of read_surface_frame.
struct SurfaceReading {
    SurfaceMesh mesh;
    std::vector<std::string> remarks = {};  // what the reader of a rig left out, without the file's name
    bool has_skin = false;                  // the surface is in its bind pose
};

// Polygons are triangulated, points split at texture seams are joined (equal coordinates, to the bit), nodes'
// transforms and the file's unit applied. A file with a skin has what its joints move, in the bind pose. mesh_name: the
// mesh or node of that name alone. InputError where there is none of that name, no triangle, or a coordinate that is
// not finite or beyond 1e9 m; a surface may be open. Remarks are dropped: this is for files that are known.
SurfaceMesh read_surface(const std::string& path, const std::string& mesh_name = "");

// The same of a file that a user names, with its remarks: a name that does not fit the content, what the reader of a
// rig left out, and those on surfaces of mesh_io.hpp. scale: of the points.
SurfaceMesh read_surface(const std::string& path, std::vector<std::string>& remarks, double scale = 1.0);

// Points and triangles as they are in the file, in its order and with its seams; each corner of a .stl is a point of
// its own. Frames of a surface have the same points in the same order. How a polygon is triangulated may depend on the
// frame. InputErrors as of read_surface.
SurfaceReading read_surface_frame(const std::string& path);

// Whether the content of a file, or else its extension, is that of a surface that read_surface takes.
bool is_surface_file(const std::string& path);

}  // namespace pbs

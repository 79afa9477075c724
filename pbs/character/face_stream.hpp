// The faces of three.js JSON, format 3.1: one stream of whole numbers, each face a type of bits, its corners, and what the bits announce.
#pragma once

#include "pbs/character/json_file.hpp"
#include "pbs/geometry/mesh_io.hpp"

namespace pbs {

// The triangles of the material named so, and the points that they use, in the file's order; quads are cut in two.
// vertices: of the file, in metres, #V x 3.
SurfaceMesh surface_of_material(const JsonFile& model, const Positions& vertices, const std::string& material);

}  // namespace pbs

// A moving surface as a .glb file that Blender and other programs show: the first frame as a mesh, every other frame as a morph target.
//   write_glb("pbs.glb", "hero", triangles, times_s, frames);
#pragma once

#include "pbs/geometry/types.hpp"

#include <string>
#include <vector>

namespace pbs {

// frames: points [m], #frames of #S x 3, 1 or more; times_s: of the frames, ascending. Between frames the points move linearly. Coordinates
// are stored in single precision, as glTF defines. An InputError where the file would be larger
// than 4 GiB or cannot be written.
void write_glb(const std::string& path, const std::string& name, const Triangles& triangles, const std::vector<double>& times_s,
               const std::vector<Positions>& frames);

}  // namespace pbs

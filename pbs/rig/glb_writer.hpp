// A moving surface as a .glb file that Blender and other programs show: the first frame as a mesh, every other frame as a morph target.
//   GlbWriter writer("pbs.glb", "hero", triangles);
//   for (...) writer.add_frame(time_s, points);
//   writer.write();
// The frames wait in a temporary file next to the .glb file, so that the memory does not depend on their number.
#pragma once

#include "pbs/geometry/files.hpp"
#include "pbs/geometry/tet_mesh.hpp"

#include <string>
#include <vector>

namespace pbs {

class GlbWriter {
public:
    // An InputError where the folder cannot be written.
    GlbWriter(std::string path, std::string name, const Triangles& triangles);

    // points [m], #S x 3, as many in every frame; times ascend. Between frames the points move linearly. Coordinates are stored in single
    // precision, as glTF defines. An InputError where the file would be larger than 4 GiB or the disk is full.
    void add_frame(double time_s, const Positions& points);

    // The file with the frames so far, 1 or more; whole or not at all, with the InputErrors of write_atomically.
    void write();

private:
    struct Extent {
        std::vector<double> smallest, largest;
    };

    std::string path_, name_;
    AtomicFile data_;  // never finished: the triangles and the points of all frames
    std::size_t corners_ = 0;
    Positions first_frame_;
    std::vector<double> times_s_;
    std::vector<Extent> extents_;  // of each frame's points, or differences from the first frame's
};

}  // namespace pbs

// A moving surface as a .glb file that Blender and other programs show: the first frame as a mesh, every other frame as
// a morph target.
//   // or, for a surface that does not look alike everywhere, (..., look, materials)
//   GlbWriter writer("pbs.glb", "hero", triangles);
//   for (...) writer.add_frame(time_s, points);
//   writer.write();
// The points of the frames wait in a temporary file next to the .glb file. The memory has the weights of the morph
// targets alone, a number for each two frames.
//   // for a surface with a skin: the first frame is its rest shape, and the others are shapes that are added to it
//   writer.write(&skin);
#pragma once

#include "experiments/rigs/rig.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/skinning/pose.hpp"
#include "pbs/system/files.hpp"

#include <map>
#include <string>
#include <vector>

namespace pbs {

// Bones that move the surface, and an animation of the bones and of the weights of the morph targets. glTF moves the
// points by the targets first, and by the bones then: x = sum_j w_j P_j (X + sum_k c_k D_k).
struct GlbSkin {
    Skeleton skeleton = {};
    // w of the points, #S; the file has as many sets of four as the most bones of a point need
    Weights weights = {};
    std::vector<double> times_s = {};     // of the keys, ascending, 1 or more
    std::vector<Pose> poses = {};         // P at these times, #keys
    Eigen::MatrixXd target_weights = {};  // c of each frame after the first one, #keys x (#frames - 1)
};

class GlbWriter {
public:
    // Triangles of one material are together, otherwise in their order. Normals are those of the surface in each frame,
    // smooth where the look's normals are and with its hard edges; without a normal in the look there are none. An
    // InputError where the folder cannot be written.
    GlbWriter(std::string path, std::string name, const Triangles& triangles, RigLook look = {},
              RigMaterials materials = {});

    // points [m], #S x 3, as many in every frame; times ascend. Between frames the points move linearly. Coordinates
    // are stored in single precision, as glTF defines. An InputError where the file would be larger than 4 GiB or the
    // disk is full.
    void add_frame(double time_s, const Positions& points);

    // The size of a file with so many frames of the points that were added, without its description.
    double bytes(int frames) const;

    // The file with the frames so far, 1 or more; whole or not at all, with the InputErrors of write_atomically. With a
    // skin, the times of the frames have no meaning.
    void write(const GlbSkin* skin = nullptr);

private:
    struct Extent {
        std::vector<double> smallest, largest;
    };

    void write_rows(const Positions& rows);
    Positions normals_of(const Positions& points) const;

    std::string path_, name_;
    AtomicFile data_;  // never finished: what does not move, then the points and normals of all frames
    double data_bytes_ = 0.0;
    Triangles triangles_;
    RigLook look_;
    RigMaterials materials_;
    bool has_normals_ = false;
    std::map<int, std::size_t> corners_;  // of the triangles of each material
    // of each point: those of one smooth piece of the surface at one place have the same normal
    std::vector<int> piece_;
    Positions first_frame_, first_normals_;
    std::vector<double> times_s_;
    std::vector<Extent> extents_;  // of each frame's points, or differences from the first frame's
};

}  // namespace pbs

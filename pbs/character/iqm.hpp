// Inter-Quake Models (IQM, version 2; http://sauerbraten.org/iqm/): the mesh and the joints in rest pose. assimp reads their meshes alone.
//   IqmModel model = read_iqm("Frankie.iqm");
#pragma once

#include "pbs/geometry/mesh_io.hpp"

#include <string>
#include <vector>

namespace pbs {

// Its rest rotation is left out: joints become heads and tails of bones.
struct IqmJoint {
    std::string name;  // as in the file
    int parent = -1;   // -1: a root; parents precede their children
    Vec3 position;     // in rest pose, in the model's coordinates and units
};

// Without its animations, materials and blend weights.
struct IqmModel {
    SurfaceMesh surface;           // of all its meshes, in the model's coordinates and units; points split at texture seams are joined
    std::vector<IqmJoint> joints;  // in the file's order
};

// A file that is cut short, of another version, or whose parts lie outside it or do not fit each other, is an InputError by field.
IqmModel read_iqm(const std::string& path);

}  // namespace pbs

// The parts of a rig that fbx_rig.cpp puts together from the objects of an FBX file: meshes and animations.
#pragma once

#include "experiments/rigs/fbx_objects.hpp"
#include "experiments/rigs/rig.hpp"

#include <map>

namespace pbs {

// What the readers of parts know of the file and add to. The nodes of the rig are complete.
struct FbxReading {
    const FbxObjects& objects;
    std::map<const FbxObject*, int> node_of;      // of each Model below the scene: index into Rig::nodes
    std::map<const FbxObject*, int> material_of;  // of each Material: its place among those of the file
    Rig& rig;
};

// Adds a mesh for each Geometry of a Model, with its geometric transform applied to the points, and with the clusters
// of its skin that move points as joints. A point of the mesh is a control point with one normal and one pair of
// coordinates per texture, if triangles use it. What is not a polygon mesh is a remark, and so are morph targets. An
// InputError names the object whose numbers are wrong, or whose kind of skinning is unknown.
void add_fbx_meshes(const FbxObject& model, FbxReading& reading);

// Adds the AnimationStacks that move a node. Times count from the stack's LocalStart, or from its first key where it
// states no times. A stack that needs what is not evaluated (two layers that move one property, curves of pivots,
// curves that repeat beyond their keys) is left out, with a remark that names the cause.
void add_fbx_animations(FbxReading& reading);

}  // namespace pbs

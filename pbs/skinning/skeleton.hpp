// The skeleton in rest pose. A bone is the segment head -> tail and moves rigidly with its joint at the head;
// rest rotations are the identity (world axes).
#pragma once

#include "pbs/geometry/types.hpp"

#include <string>
#include <vector>

namespace pbs {

// Skeletons from files have names given once, bones with a length, and at least one root; those made by hand are not checked.
struct Bone {
    std::string name;  // what clips, weights files and find_bone know it by
    int parent = -1;   // index into Skeleton::bones, -1 for a root; parents precede their children
    Vec3 head;         // s_j [m]
    Vec3 tail;         // d_j [m]
};

// The order of bones is that of a Pose's transforms and of the indices in weights and bindings.
struct Skeleton {
    std::vector<Bone> bones;  // parents before their children
};

int find_bone(const Skeleton& skeleton, const std::string& name);  // -1 where there is none

// Bones that meet at an end of bone j (Eq. 2's n_joints, which the paper does not define: it is read as this), j itself first. At the head:
// the parent (wherever it ends), and siblings and children that start there; at the tail: the children that start there. "There" is within
// 2 % of the skeleton's bounding diagonal.
enum class BoneEnd { head, tail };
// Indices into Skeleton::bones; `bone` is one of them (unchecked).
std::vector<int> bones_meeting(const Skeleton& skeleton, int bone, BoneEnd end);

}  // namespace pbs

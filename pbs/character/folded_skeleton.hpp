// A rig of many joints folded to fewer bones: each end of a bone is the mean of named points of the rig.
//   Skeleton skeleton = fold_skeleton({{"thigh.*", "pelvis", {"hip.*"}, {"knee.*"}}, ...}, "rig.json", point_named);
#pragma once

#include "pbs/skinning/pose.hpp"

#include <functional>
#include <string>
#include <vector>

namespace pbs {

// A star in a name stands for L and R, so that one entry describes two bones. parent "": the root.
struct FoldedBone {
    // The name may contain a star.
    std::string name, parent;  // a bone's name with its star; "": the root
    // Points of the rig whose mean the bone's head is.
    std::vector<std::string> head, tail;  // those of its tail
};

// Bones in the middle first, then those of the left, then those of the right. `file` stands for the rig in errors.
Skeleton fold_skeleton(const std::vector<FoldedBone>& bones, const std::string& file,
                       const std::function<Vec3(const std::string& point)>& point_named);

}  // namespace pbs

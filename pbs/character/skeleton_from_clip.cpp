#include "pbs/character/skeleton_from_clip.hpp"

#include "pbs/geometry/input_error.hpp"

namespace pbs {
namespace {

// The first child of each joint that does not coincide with it, -1 where there is none, #joints.
std::vector<int> first_children(const Clip& clip)
{
    std::vector<int> child(clip.joints.size(), -1);
    for (int j = 0; j < static_cast<int>(clip.joints.size()); ++j) {
        const int parent = clip.parent[j];
        if (parent >= 0 && child[parent] < 0 && clip.zero_pose.row(j) != clip.zero_pose.row(parent)) child[parent] = j;
    }
    return child;
}

}  // namespace

Skeleton skeleton_from_clip(const Clip& clip, double scale)
{
    const std::vector<int> child = first_children(clip);
    std::vector<int> bone_of(clip.joints.size(), -1);  // of the joint, or of the next joint above that has one
    Skeleton skeleton;
    for (int j = 0; j < static_cast<int>(clip.joints.size()); ++j) {
        const int above = clip.parent[j] >= 0 ? bone_of[clip.parent[j]] : -1;
        bone_of[j] = above;
        if (child[j] < 0) continue;
        bone_of[j] = static_cast<int>(skeleton.bones.size());
        skeleton.bones.push_back(
            {clip.joints[j], above, scale * clip.zero_pose.row(j).transpose(), scale * clip.zero_pose.row(child[j]).transpose()});
    }
    if (skeleton.bones.empty())
        throw InputError(clip.name, 0, "joints", std::to_string(clip.joints.size()), "expected joints apart from each other");
    return skeleton;
}

}  // namespace pbs

#include "pbs/character/retarget_plan.hpp"

#include "pbs/character/joint_map.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/name_list.hpp"

#include <algorithm>
#include <cmath>

namespace pbs {
namespace {

constexpr double shortest_limb = 1e-6;  // of the zero pose's extent: CMU's hip joints and the like have no length

int joint_named(const Clip& clip, const std::string& name)
{
    const auto found = std::find(clip.joints.begin(), clip.joints.end(), name);
    return name.empty() || found == clip.joints.end() ? -1 : static_cast<int>(found - clip.joints.begin());
}

std::vector<int> children_of(const Clip& clip, int joint)
{
    std::vector<int> children;
    for (int j = 0; j < static_cast<int>(clip.parent.size()); ++j)
        if (clip.parent[j] == joint) children.push_back(j);
    return children;
}

// Vector from the joint to the first descendant at another position, along first children; zero where there is none.
Vec3 limb_of(const Clip& clip, int joint)
{
    const double extent = (clip.zero_pose.colwise().maxCoeff() - clip.zero_pose.colwise().minCoeff()).norm();
    for (std::vector<int> below = children_of(clip, joint); !below.empty(); below = children_of(clip, below.front()))
        for (const int child : below) {
            const Vec3 limb = clip.zero_pose.row(child) - clip.zero_pose.row(joint);
            if (limb.norm() > shortest_limb * extent) return limb;
        }
    return Vec3::Zero();
}

JointMapping mapping_of(const Bone& bone, const Clip& clip)
{
    for (const JointMapping& mapping : cmu_joint_map())
        if (mapping.bone == bone.name && joint_named(clip, mapping.joint) >= 0) return mapping;
    const int joint = joint_named(clip, bone.name);
    return {bone.name, bone.name, joint >= 0 && children_of(clip, joint).size() == 1};
}

BoneFollowing follow(const Bone& bone, const JointMapping& mapping, const Clip& clip)
{
    BoneFollowing following;
    following.joint = joint_named(clip, mapping.joint);
    if (following.joint < 0) return following;
    following.limb = limb_of(clip, following.joint);
    if (mapping.aligned && !following.limb.isZero(0.0))
        following.alignment = Eigen::Quaterniond::FromTwoVectors(bone.tail - bone.head, following.limb);
    following.twist_joint = joint_named(clip, mapping.twist_joint);
    following.twist_share = mapping.twist_share;
    return following;
}

[[noreturn]] void refuse(const Clip& clip, const Skeleton& skeleton, const std::string& why)
{
    std::vector<std::string> bones;
    for (const Bone& bone : skeleton.bones) bones.push_back(bone.name);
    throw InputError(clip.name, 0, "joints", name_list(clip.joints), why + " (bones: " + name_list(bones) + ")");
}

// Bone lengths over limb lengths: of the legs where the map knows them, else of all bones that follow.
double scale_of(const std::vector<double>& lengths, const RetargetPlan& plan, const std::vector<bool>& counts)
{
    double bones = 0.0, limbs = 0.0;
    for (std::size_t b = 0; b < lengths.size(); ++b) {
        const double limb = plan.bones[b].limb.norm();
        if (!counts[b] || limb == 0.0) continue;
        bones += lengths[b];
        limbs += limb;
    }
    return limbs > 0.0 ? bones / limbs : 1.0;
}

}  // namespace

RetargetPlan plan_retargeting(const Clip& clip, const Skeleton& skeleton)
{
    RetargetPlan plan;
    std::vector<double> lengths;
    std::vector<bool> is_leg, follows;
    bool by_map = false;
    for (const Bone& bone : skeleton.bones) {
        const JointMapping mapping = mapping_of(bone, clip);
        plan.bones.push_back(follow(bone, mapping, clip));
        lengths.push_back((bone.tail - bone.head).norm());
        follows.push_back(plan.bones.back().joint >= 0);
        is_leg.push_back(mapping.leg && follows.back());
        by_map = by_map || (follows.back() && mapping.joint != bone.name);
    }
    if (std::find(follows.begin(), follows.end(), true) == follows.end()) refuse(clip, skeleton, "no joint has the name of a bone");
    const bool has_legs = std::find(is_leg.begin(), is_leg.end(), true) != is_leg.end();
    if (by_map && !has_legs) refuse(clip, skeleton, "some joints have CMU's names, but the legs' are missing");
    plan.scale = scale_of(lengths, plan, has_legs ? is_leg : follows);
    return plan;
}

double twist_angle(const Eigen::Quaterniond& rotation, const Vec3& axis)
{
    double angle = 2.0 * std::atan2(rotation.vec().dot(axis), rotation.w());
    if (angle > M_PI) angle -= 2.0 * M_PI;
    if (angle <= -M_PI) angle += 2.0 * M_PI;
    return angle;
}

}  // namespace pbs

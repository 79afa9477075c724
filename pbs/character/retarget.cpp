#include "pbs/character/clip.hpp"

#include "pbs/geometry/input_error.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <system_error>

namespace pbs {
namespace {

using Rotations = std::vector<Eigen::Quaterniond>;

constexpr double shortest_limb = 1e-6;      // of the zero pose's extent: CMU's hip joints and the like have no length
constexpr double rounding = 1e-6;           // of a frame: times given in decimal are not refused for their last digit
constexpr double same_rotation_rad = 1e-4;  // of keys in single precision, with margin

// The plan of one bone. Without a joint it follows its parent.
struct BoneFollowing : JointMapping {
    Eigen::Quaterniond alignment = Eigen::Quaterniond::Identity();  // A: rest direction of the bone -> limb in the zero pose
    Vec3 limb = Vec3::Zero();                                       // to the end of the joint's limb in the zero pose [clip's units]
};

// The plans of all bones of a skeleton, in its order.
struct RetargetPlan {
    std::vector<BoneFollowing> bones;  // #bones
    double scale = 1.0;  // [m] per clip unit: bones' lengths over limbs', of the legs where they are known, else of all that follow
};

std::vector<int> children_of(const Clip& clip, int joint)
{
    std::vector<int> children;
    for (int j = 0; j < static_cast<int>(clip.parent.size()); ++j)
        if (clip.parent[j] == joint) children.push_back(j);
    return children;
}

// Vector from the joint to the first of limb_end and its descendants at another position, along first children; zero where there is none.
// limb_end -1: the joint's children, of which a thumb points to the side of its hand.
Vec3 limb_of(const Clip& clip, int joint, int limb_end)
{
    const double extent = (clip.zero_pose.colwise().maxCoeff() - clip.zero_pose.colwise().minCoeff()).norm();
    for (std::vector<int> below = limb_end < 0 ? children_of(clip, joint) : std::vector{limb_end}; !below.empty();
         below = children_of(clip, below.front()))
        for (const int child : below) {
            if (clip.joints[child].find("humb") != std::string::npos) continue;
            const Vec3 limb = clip.zero_pose.row(child) - clip.zero_pose.row(joint);
            if (limb.norm() > shortest_limb * extent) return limb;
        }
    return Vec3::Zero();
}

// An InputError where the map has no joint for any bone.
RetargetPlan plan_retargeting(const Clip& clip, const Skeleton& skeleton, const JointMap& map)
{
    RetargetPlan plan;
    std::vector<std::string> names;
    bool follows = false;
    Eigen::Vector2d legs(0.0, 0.0), all(0.0, 0.0);  // lengths of the bones [m] and of their limbs
    for (std::size_t b = 0; b < skeleton.bones.size(); ++b) {
        const Vec3 bone = skeleton.bones[b].tail - skeleton.bones[b].head;
        BoneFollowing following{map.bones[b]};
        names.push_back(skeleton.bones[b].name);
        follows = follows || following.joint >= 0;
        if (following.joint >= 0) following.limb = limb_of(clip, following.joint, following.limb_end);
        if (!following.limb.isZero(0.0)) {
            if (following.aligned) following.alignment = Eigen::Quaterniond::FromTwoVectors(bone, following.limb);
            const Eigen::Vector2d lengths(bone.norm(), following.limb.norm());
            all += lengths;
            if (following.leg) legs += lengths;
        }
        plan.bones.push_back(following);
    }
    if (!follows)
        throw InputError(clip.name, 0, "joints", name_list(clip.joints),
                         "no joint has the name of a bone (bones: " + name_list(names) + ")");
    const Eigen::Vector2d& lengths = legs(1) > 0.0 ? legs : all;
    plan.scale = lengths(1) > 0.0 ? lengths(0) / lengths(1) : 1.0;
    return plan;
}

// Local rotations and root position of the clip at `frame`, which may lie between two.
struct ClipPose {
    Rotations local;
    Vec3 root;
};

ClipPose sample(const Clip& clip, double frame)
{
    const int before = std::clamp(static_cast<int>(std::floor(frame)), 0, clip.frames() - 1);
    const int after = std::min(before + 1, clip.frames() - 1);
    const double between = std::clamp(frame - before, 0.0, 1.0);
    ClipPose pose;
    for (std::size_t j = 0; j < clip.joints.size(); ++j) pose.local.push_back(clip.local[before][j].slerp(between, clip.local[after][j]));
    pose.root = (1.0 - between) * clip.root.row(before) + between * clip.root.row(after);
    return pose;
}

Rotations global_rotations(const Rotations& local, const std::vector<int>& parent)
{
    Rotations global;
    for (std::size_t j = 0; j < local.size(); ++j) global.push_back(parent[j] < 0 ? local[j] : global[parent[j]] * local[j]);
    return global;
}

// R_bone = R_joint (share of the twist) A.
Eigen::Quaterniond bone_rotation(const BoneFollowing& bone, const Rotations& joints)
{
    const Eigen::Quaterniond& joint = joints[bone.joint];
    if (bone.twist_joint < 0) return joint * bone.alignment;
    const Vec3 axis = bone.limb.normalized();
    const double angle = twist_angle(joint.conjugate() * joints[bone.twist_joint], axis);
    return joint * Eigen::AngleAxisd(bone.twist_share * angle, axis) * bone.alignment;
}

Pose pose_of(const RetargetPlan& plan, const Skeleton& skeleton, const Rotations& joints, const Vec3& root_translation)
{
    Rotations global, local;
    for (std::size_t b = 0; b < skeleton.bones.size(); ++b) {
        const int parent = skeleton.bones[b].parent;
        const Eigen::Quaterniond above = parent < 0 ? Eigen::Quaterniond::Identity() : global[parent];
        global.push_back(plan.bones[b].joint < 0 ? above : bone_rotation(plan.bones[b], joints));
        local.push_back((above.conjugate() * global.back()).normalized());
    }
    return pose_from_joints(skeleton, local, root_translation);
}

bool moves(const Clip& clip, std::size_t joint)
{
    return std::any_of(clip.local.begin(), clip.local.end(), [&](const std::vector<Eigen::Quaterniond>& frame) {
        return clip.local.front()[joint].angularDistance(frame[joint]) > same_rotation_rad;
    });
}

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

double twist_angle(const Eigen::Quaterniond& rotation, const Vec3& axis)
{
    double angle = 2.0 * std::atan2(rotation.vec().dot(axis), rotation.w());
    if (angle > M_PI) angle -= 2.0 * M_PI;
    if (angle <= -M_PI) angle += 2.0 * M_PI;
    return angle;
}

Motion retarget(const Clip& clip, const Skeleton& skeleton, const ClipSampling& sampling)
{
    const int first = sampling.drop_first_frame ? 1 : 0;
    if (clip.frames() <= first) throw InputError(clip.name, 0, "Frames", std::to_string(clip.frames()), "no frame is left after the first");
    const RetargetPlan plan = plan_retargeting(clip, skeleton, joint_map(clip, skeleton));

    Motion motion;
    motion.time_step_s = sampling.time_step_s;
    motion.steps_per_frame = steps_per_frame(sampling);
    const double length_s = (clip.frames() - 1 - first) * clip.frame_time_s;
    const int frames = frames_after_the_first(sampling, length_s, rounding * clip.frame_time_s, clip.name);
    const int steps = frames * motion.steps_per_frame;
    for (int step = 0; step <= steps; ++step) {
        const double time_s = sampling.start_s + step * sampling.time_step_s;
        const ClipPose source = sample(clip, first + time_s / clip.frame_time_s);
        const Vec3 moved = plan.scale * (source.root - clip.root.row(first).transpose());
        motion.steps.push_back(pose_of(plan, skeleton, global_rotations(source.local, clip.parent), moved));
    }
    return motion;
}

ClipMatch match_of(const Clip& clip, const Skeleton& skeleton)
{
    const JointMap map = joint_map(clip, skeleton);
    const RetargetPlan plan = plan_retargeting(clip, skeleton, map);
    ClipMatch match;
    std::set<int> followed;
    for (std::size_t b = 0; b < plan.bones.size(); ++b)
        if (plan.bones[b].joint >= 0)
            followed.insert({plan.bones[b].joint, plan.bones[b].twist_joint});
        else
            match.bones_without_joint.push_back(skeleton.bones[b].name);
    for (std::size_t j = 0; j < clip.joints.size(); ++j) {
        if (!moves(clip, j)) continue;
        ++match.moving;
        match.matched += static_cast<int>(followed.count(static_cast<int>(j)));
        if (followed.count(static_cast<int>(j)) > 0) continue;
        match.unmatched.push_back(clip.joints[j]);
        match.small += map.is_small[j];
    }
    return match;
}

double largest_rotation_deg(const Motion& motion)
{
    double largest = 0.0;
    for (const Pose& pose : motion.steps)
        for (std::size_t bone = 0; bone < pose.size(); ++bone)
            largest = std::max(largest, Eigen::AngleAxisd(motion.steps.front()[bone].linear().transpose() * pose[bone].linear()).angle());
    return largest * 180.0 / M_PI;
}

double largest_displacement_m(const Motion& motion, const Skeleton& skeleton)
{
    double largest = 0.0;
    for (const Pose& pose : motion.steps)
        for (std::size_t b = 0; b < pose.size(); ++b)
            for (const Vec3& end : {skeleton.bones[b].head, skeleton.bones[b].tail})
                largest = std::max(largest, (pose[b] * end - motion.steps.front()[b] * end).norm());
    return largest;
}

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

std::string find_clip(const std::string& name, const std::string& folder)
{
    namespace fs = std::filesystem;
    const std::string installed_folder = "/usr/share/assimp/models/BVH";
    std::error_code code;  // a name that is too long, or a loop of links, is no file either
    for (const fs::path& candidate : {fs::path(name), fs::path(folder) / name, fs::path(installed_folder) / name})
        if (fs::is_regular_file(candidate, code)) return candidate.string();
    throw InputError("", 0, "motion.clip", name,
                     "not found as it is, in '" + folder + "' or in " + installed_folder + " (package assimp-testmodels)");
}

}  // namespace pbs

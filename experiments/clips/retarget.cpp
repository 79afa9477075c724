#include "experiments/clips/clip.hpp"

#include "experiments/clips/body_axes.hpp"
#include "pbs/geometry/extent.hpp"
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
    // A: rest direction of the bone -> limb in the rest pose
    Eigen::Quaterniond alignment = Eigen::Quaterniond::Identity();
    // to the end of the joint's limb in the rest pose [clip's units]
    Vec3 limb = Vec3::Zero();
};

// The plans of all bones of a skeleton, in its order.
struct RetargetPlan {
    std::vector<BoneFollowing> bones;  // #bones
    double scale = 1.0;  // [m] per clip unit: bones' lengths over limbs', of the legs where they are known, else of all
                         // that follow
    // C: from the axes of the clip's body to those of the skeleton's
    Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
    Rotations rest;       // turns of the joints from the zero pose to the rest pose, #joints; empty: they are one
    int root_joint = -1;  // that moves the root bone
};

std::vector<int> children_of(const Clip& clip, int joint)
{
    std::vector<int> children;
    for (int j = 0; j < static_cast<int>(clip.parent.size()); ++j)
        if (clip.parent[j] == joint) children.push_back(j);
    return children;
}

// Vector from the joint to the first of limb_end and its descendants at another position, along first children; zero
// where there is none. limb_end -1: the joint's children, of which a thumb points to the side of its hand.
Vec3 limb_of(const Clip& clip, const Positions& rest, int joint, int limb_end)
{
    const double extent = diagonal_m(rest);
    for (std::vector<int> below = limb_end < 0 ? children_of(clip, joint) : std::vector{limb_end}; !below.empty();
         below = children_of(clip, below.front()))
        for (const int child : below) {
            if (clip.joints[child].find("humb") != std::string::npos) continue;
            const Vec3 limb = rest.row(child) - rest.row(joint);
            if (limb.norm() > shortest_limb * extent) return limb;
        }
    return Vec3::Zero();
}

Rotations global_rotations(const Rotations& local, const std::vector<int>& parent)
{
    Rotations global;
    for (std::size_t j = 0; j < local.size(); ++j)
        global.push_back(parent[j] < 0 ? local[j] : global[parent[j]] * local[j]);
    return global;
}

// The joint of the first bone that has one and none above it that has one; -1: there is none.
int root_joint_of(const Skeleton& skeleton, const JointMap& map)
{
    for (std::size_t b = 0; b < skeleton.bones.size(); ++b)
        if (map.bones[b].joint >= 0) return map.bones[b].joint;  // parents come first
    return -1;
}

// The pose from which the turns of the clip are measured.
const Positions& rest_places(const Clip& clip, int frame)
{
    return frame < 0 ? clip.zero_pose : clip.places[static_cast<std::size_t>(frame)];
}

// InputErrors: the map has no joint for any bone, or the rest pose of the clip cannot be known.
RetargetPlan plan_retargeting(const Clip& clip, const Skeleton& skeleton, const JointMap& map)
{
    RetargetPlan plan;
    plan.root_joint = root_joint_of(skeleton, map);
    if (plan.root_joint < 0) {
        std::vector<std::string> names;
        for (const Bone& bone : skeleton.bones) names.push_back(bone.name);
        throw InputError(clip.name, 0, "joints", name_list(clip.joints),
                         "no joint has the name of a bone (bones: " + name_list(names) +
                             "): rename the joints of the clip as the bones, or as those of Mixamo or another program "
                             "that motion.clip knows");
    }
    const int rest_frame_of_clip = rest_frame(clip, map.of_clip);
    const Positions& rest = rest_places(clip, rest_frame_of_clip);
    if (rest_frame_of_clip >= 0) plan.rest = global_rotations(clip.local[rest_frame_of_clip], clip.parent);
    plan.axes = axes_of_clip_to_skeleton(rest, skeleton, map);
    Eigen::Vector2d legs(0.0, 0.0), all(0.0, 0.0);  // lengths of the bones [m] and of their limbs
    for (std::size_t b = 0; b < skeleton.bones.size(); ++b) {
        const Vec3 bone = skeleton.bones[b].tail - skeleton.bones[b].head;
        BoneFollowing following{map.bones[b]};
        if (following.joint >= 0) following.limb = plan.axes * limb_of(clip, rest, following.joint, following.limb_end);
        if (!following.limb.isZero(0.0)) {
            if (following.aligned) following.alignment = Eigen::Quaterniond::FromTwoVectors(bone, following.limb);
            const Eigen::Vector2d lengths(bone.norm(), following.limb.norm());
            all += lengths;
            if (following.leg) legs += lengths;
        }
        plan.bones.push_back(following);
    }
    const Eigen::Vector2d& lengths = legs(1) > 0.0 ? legs : all;
    plan.scale = lengths(1) > 0.0 ? lengths(0) / lengths(1) : 1.0;
    return plan;
}

// Local rotations and places of the clip's joints at `frame`, which may lie between two.
struct ClipPose {
    Rotations local;
    Positions places;
};

ClipPose sample(const Clip& clip, double frame)
{
    const int before = std::clamp(static_cast<int>(std::floor(frame)), 0, clip.frames() - 1);
    const int after = std::min(before + 1, clip.frames() - 1);
    const double between = std::clamp(frame - before, 0.0, 1.0);
    ClipPose pose;
    pose.places = (1.0 - between) * clip.places[before] + between * clip.places[after];
    for (std::size_t j = 0; j < clip.joints.size(); ++j) {
        const bool holds = !clip.holds.empty() && clip.holds[j];
        const int held = between > 1.0 - rounding ? after : before;  // a step belongs to the frame at its own time
        pose.local.push_back(holds ? clip.local[held][j] : clip.local[before][j].slerp(between, clip.local[after][j]));
        if (holds) pose.places.row(static_cast<Eigen::Index>(j)) = clip.places[held].row(static_cast<Eigen::Index>(j));
    }
    return pose;
}

// Turns of the joints from the rest pose, in the axes of the skeleton's body.
Rotations joint_turns(const RetargetPlan& plan, const Clip& clip, const Rotations& local)
{
    Rotations turns = global_rotations(local, clip.parent);
    for (std::size_t j = 0; j < plan.rest.size(); ++j) turns[j] = turns[j] * plan.rest[j].conjugate();
    if (plan.axes.isIdentity(0.0)) return turns;
    const Eigen::Quaterniond axes(plan.axes);
    for (Eigen::Quaterniond& turn : turns) turn = axes * turn * axes.conjugate();
    return turns;
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

// The first child of each joint that does not coincide with it, -1 where there is none, #joints.
std::vector<int> first_children(const Clip& clip, const Positions& rest)
{
    std::vector<int> child(clip.joints.size(), -1);
    for (int j = 0; j < static_cast<int>(clip.joints.size()); ++j) {
        const int parent = clip.parent[j];
        if (parent >= 0 && child[parent] < 0 && rest.row(j) != rest.row(parent)) child[parent] = j;
    }
    return child;
}

}  // namespace

bool joint_moves(const Clip& clip, std::size_t joint)
{
    return std::any_of(clip.local.begin(), clip.local.end(), [&](const std::vector<Eigen::Quaterniond>& frame) {
        return clip.local.front()[joint].angularDistance(frame[joint]) > same_rotation_rad;
    });
}

double twist_angle(const Eigen::Quaterniond& rotation, const Vec3& axis)
{
    double angle = 2.0 * std::atan2(rotation.vec().dot(axis), rotation.w());
    if (angle > M_PI) angle -= 2.0 * M_PI;
    if (angle <= -M_PI) angle += 2.0 * M_PI;
    return angle;
}

int first_frame_of_motion(const Clip& clip)
{
    const auto is_unturned = [](const Eigen::Quaterniond& turn) {
        return turn.angularDistance(Eigen::Quaterniond::Identity()) <= same_rotation_rad;
    };
    return std::ranges::all_of(clip.local.front(), is_unturned) ||
                   is_t_or_a_pose(clip.places.front(), body_joints(clip))
               ? 1
               : 0;
}

Motion retarget(const Clip& clip, const Skeleton& skeleton, const ClipSampling& sampling,
                std::vector<PartAngle>* angles)
{
    const int first = sampling.drops_rest_pose ? first_frame_of_motion(clip) : 0;
    if (clip.frames() <= first)
        throw InputError(clip.name, 0, "Frames", std::to_string(clip.frames()), "no frame is left after the first");
    const JointMap map = joint_map(clip, skeleton);
    const RetargetPlan plan = plan_retargeting(clip, skeleton, map);
    const std::vector<BodySegment> segments = body_segments(map);
    std::vector<PartAngle> found;
    for (const BodySegment& segment : segments) found.push_back({segment.part});

    Motion motion;
    motion.time_step_s = sampling.time_step_s;
    motion.steps_per_frame = steps_per_frame(sampling);
    const double length_s = (clip.frames() - 1 - first) * clip.frame_time_s;
    const int frames = frames_after_the_first(sampling, length_s, rounding * clip.frame_time_s, clip.name);
    const int steps = frames * motion.steps_per_frame;
    for (int step = 0; step <= steps; ++step) {
        const double time_s = sampling.start_s + step * sampling.time_step_s;
        const ClipPose source = sample(clip, first + time_s / clip.frame_time_s);
        const Vec3 moved = plan.scale * (source.places.row(plan.root_joint) - clip.places[first].row(plan.root_joint));
        motion.steps.push_back(pose_of(plan, skeleton, joint_turns(plan, clip, source.local), plan.axes * moved));
        const Positions body = posed_heads(skeleton, motion.steps.back()),
                        joints = source.places * plan.axes.transpose();
        if (step == 0) check_trunk(clip, map, body, joints);
        for (std::size_t s = 0; s < segments.size(); ++s)
            found[s].largest_deg = std::max(
                found[s].largest_deg, angle_deg(body.row(segments[s].to_bone) - body.row(segments[s].from_bone),
                                                joints.row(segments[s].to_joint) - joints.row(segments[s].from_joint)));
    }
    if (angles) *angles = found;
    return motion;
}

ClipMatch match_of(const Clip& clip, const Skeleton& skeleton)
{
    const JointMap map = joint_map(clip, skeleton);
    const RetargetPlan plan = plan_retargeting(clip, skeleton, map);
    ClipMatch match;
    match.torn = map.torn;
    std::set<int> followed;
    for (std::size_t b = 0; b < plan.bones.size(); ++b)
        if (plan.bones[b].joint >= 0)
            followed.insert({plan.bones[b].joint, plan.bones[b].twist_joint});
        else
            match.bones_without_joint.push_back(skeleton.bones[b].name);
    for (std::size_t j = 0; j < clip.joints.size(); ++j) {
        if (!joint_moves(clip, j)) continue;
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
            largest = std::max(
                largest,
                Eigen::AngleAxisd(motion.steps.front()[bone].linear().transpose() * pose[bone].linear()).angle());
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
    const Positions& rest = rest_places(clip, rest_frame(clip, body_joints(clip)));
    const std::vector<int> child = first_children(clip, rest);
    std::vector<int> bone_of(clip.joints.size(), -1);  // of the joint, or of the next joint above that has one
    Skeleton skeleton;
    for (int j = 0; j < static_cast<int>(clip.joints.size()); ++j) {
        const int above = clip.parent[j] >= 0 ? bone_of[clip.parent[j]] : -1;
        bone_of[j] = above;
        if (child[j] < 0) continue;
        bone_of[j] = static_cast<int>(skeleton.bones.size());
        skeleton.bones.push_back(
            {clip.joints[j], above, scale * rest.row(j).transpose(), scale * rest.row(child[j]).transpose()});
    }
    if (skeleton.bones.empty())
        throw InputError(clip.name, 0, "joints", std::to_string(clip.joints.size()),
                         "expected joints apart from each other");
    return skeleton;
}

std::string find_clip(const std::string& name, const std::string& folder)
{
    namespace fs = std::filesystem;
    const std::string installed_folder = "/usr/share/assimp/models/BVH";
    std::error_code code;  // a name that is too long, or a loop of links, is no file either
    for (const fs::path& candidate : {fs::path(name), fs::path(folder) / name, fs::path(installed_folder) / name})
        if (fs::is_regular_file(candidate, code)) return candidate.string();
    throw InputError(
        "", 0, "motion.clip", name,
        "not found as it is, in '" + folder + "' or in " + installed_folder + " (package assimp-testmodels)");
}

}  // namespace pbs

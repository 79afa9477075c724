#include "pbs/skinning/pose.hpp"

#include "pbs/geometry/input_error.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pbs {
namespace {

constexpr double meeting_distance_per_diagonal = 0.02;

double bounding_diagonal(const Skeleton& skeleton)
{
    Eigen::AlignedBox3d box;
    for (const Bone& bone : skeleton.bones) box.extend(bone.head).extend(bone.tail);
    return box.diagonal().norm();
}

void check_sweep(const Skeleton& skeleton, int joint, const Vec3& axis, int frames)
{
    if (joint < 0 || joint >= static_cast<int>(skeleton.bones.size()))
        throw InputError("joint sweep", 0, "joint", std::to_string(joint), "expected a bone of the skeleton");
    if (!(axis.stableNorm() > 0.0) || !axis.allFinite())
        throw InputError("joint sweep", 0, "axis", "", "expected a direction, not zero");
    if (frames < 1) throw InputError("joint sweep", 0, "frames", std::to_string(frames), "expected at least 1");
}

Eigen::Isometry3d parent_of(const Bone& bone, const Pose& pose)
{
    return bone.parent < 0 ? Eigen::Isometry3d::Identity() : pose[bone.parent];
}

constexpr double most_steps_per_frame = 1e5;
constexpr double rounding = 1e-6;  // of a step or frame: times given in decimal are not refused for their last digit

}  // namespace

std::vector<int> bones_that_move_as_one(const Skeleton& skeleton, const std::vector<Pose>& poses, double size_m)
{
    constexpr double most_apart = 1e-3;  // over the size
    Vec3 centre = Vec3::Zero();
    for (const Bone& bone : skeleton.bones) centre += bone.head / static_cast<double>(skeleton.bones.size());
    const auto moves_with = [&](std::size_t bone, std::size_t other) {
        return std::ranges::all_of(poses, [&](const Pose& pose) {
            // the Frobenius norm bounds the turn
            const double turned_m = (pose[bone].linear() - pose[other].linear()).norm() * size_m;
            return turned_m + (pose[bone] * centre - pose[other] * centre).norm() <= most_apart * size_m;
        });
    };
    std::vector<int> first;
    for (std::size_t bone = 0; bone < skeleton.bones.size(); ++bone) {
        std::size_t other = 0;
        while (other < bone && !(first[other] == static_cast<int>(other) && moves_with(bone, other))) ++other;
        first.push_back(static_cast<int>(other));
    }
    return first;
}

int find_bone(const Skeleton& skeleton, const std::string& name)
{
    const auto found = std::ranges::find(skeleton.bones, name, &Bone::name);
    return found == skeleton.bones.end() ? -1 : static_cast<int>(found - skeleton.bones.begin());
}

std::vector<int> bones_meeting(const Skeleton& skeleton, int bone, BoneEnd end)
{
    const Bone& own = skeleton.bones[bone];
    const Vec3& joint = end == BoneEnd::head ? own.head : own.tail;
    const double tolerance = meeting_distance_per_diagonal * bounding_diagonal(skeleton);

    std::vector<int> meeting = {bone};
    if (end == BoneEnd::head && own.parent >= 0) meeting.push_back(own.parent);
    for (int j = 0; j < static_cast<int>(skeleton.bones.size()); ++j) {
        const Bone& other = skeleton.bones[j];
        const bool child = other.parent == bone;
        const bool sibling = end == BoneEnd::head && j != bone && other.parent == own.parent;
        if ((child || sibling) && (other.head - joint).norm() <= tolerance) meeting.push_back(j);
    }
    return meeting;
}

Pose pose_from_joints(const Skeleton& skeleton, const std::vector<Eigen::Quaterniond>& local_rotations,
                      const Vec3& root_translation)
{
    Pose pose(skeleton.bones.size());
    for (std::size_t j = 0; j < skeleton.bones.size(); ++j) {
        const Bone& bone = skeleton.bones[j];
        const bool root = bone.parent < 0;
        const Eigen::Matrix3d local = local_rotations[j].normalized().toRotationMatrix();
        const Eigen::Matrix3d rotation = root ? local : Eigen::Matrix3d(pose[bone.parent].linear() * local);
        const Vec3 posed_head = root ? Vec3(bone.head + root_translation) : Vec3(pose[bone.parent] * bone.head);
        pose[j] = Eigen::Isometry3d::Identity();
        pose[j].linear() = rotation;
        pose[j].translation() = posed_head - rotation * bone.head;
    }
    return pose;
}

Motion joint_sweep(const Skeleton& skeleton, int joint, const Vec3& axis, double angle_deg, int frames,
                   double time_step_s)
{
    check_sweep(skeleton, joint, axis, frames);
    Motion motion;
    motion.time_step_s = time_step_s;
    const Vec3 direction = axis.stableNormalized();
    std::vector<Eigen::Quaterniond> local_rotations(skeleton.bones.size(), Eigen::Quaterniond::Identity());
    for (int frame = 0; frame < frames; ++frame) {
        const double angle = frame == 0 ? 0.0 : angle_deg * frame / (frames - 1);
        local_rotations[joint] = Eigen::AngleAxisd(angle * std::numbers::pi / 180.0, direction);
        motion.steps.push_back(pose_from_joints(skeleton, local_rotations, Vec3::Zero()));
        motion.angle_deg.push_back(angle);
    }
    return motion;
}

PosePath::PosePath(const Skeleton& skeleton, const Pose& from, const Pose& to)
    : skeleton_(skeleton), from_(from), to_(to), start_(joints_of(from)), end_(joints_of(to))
{
}

std::vector<PosePath::Joint> PosePath::joints_of(const Pose& pose) const
{
    std::vector<Joint> joints;
    for (std::size_t j = 0; j < pose.size(); ++j) {
        const Bone& bone = skeleton_.bones[j];
        const Eigen::Isometry3d in_parent = parent_of(bone, pose).inverse() * pose[j];
        joints.push_back({Eigen::Quaterniond(in_parent.linear()), in_parent * bone.head});
    }
    return joints;
}

Pose PosePath::at(double fraction) const
{
    if (fraction == 0.0) return from_;
    if (fraction == 1.0) return to_;
    Pose pose(from_.size(), Eigen::Isometry3d::Identity());
    for (std::size_t j = 0; j < pose.size(); ++j) {
        const Bone& bone = skeleton_.bones[j];
        const Eigen::Isometry3d parent = parent_of(bone, pose);
        const Vec3 head = parent * Vec3((1.0 - fraction) * start_[j].head + fraction * end_[j].head);
        pose[j].linear() = parent.linear() * start_[j].rotation.slerp(fraction, end_[j].rotation).toRotationMatrix();
        pose[j].translation() = head - pose[j].linear() * bone.head;
    }
    return pose;
}

double PosePath::largest_turn_deg() const
{
    double largest = 0.0;
    for (std::size_t j = 0; j < from_.size(); ++j)
        largest = std::max(largest,
                           Eigen::Quaterniond(from_[j].linear()).angularDistance(Eigen::Quaterniond(to_[j].linear())));
    return largest * 180.0 / std::numbers::pi;
}

RootFrame::RootFrame(const Skeleton& skeleton, const Pose& pose) : pose_(pose)
{
    const auto& bones = skeleton.bones;
    const auto root = std::find_if(bones.begin(), bones.end(), [](const Bone& bone) { return bone.parent < 0; });
    root_ = pose[root - bones.begin()];
    for (Eigen::Isometry3d& bone : pose_) bone = root_.inverse() * bone;
}

Positions RootFrame::to_world(const Positions& points) const
{
    return (points * root_.linear().transpose()).rowwise() + root_.translation().transpose();
}

Positions RootFrame::to_root(const Positions& points) const
{
    return (points.rowwise() - root_.translation().transpose()) * root_.linear();
}

int steps_per_frame(const MotionSampling& sampling)
{
    if (!(sampling.rate_hz > 0.0))
        throw InputError("", 0, "rate_hz", std::to_string(sampling.rate_hz), "expected a rate > 0");
    if (!(sampling.time_step_s > 0.0))
        throw InputError("", 0, "time_step_s", std::to_string(sampling.time_step_s), "expected a time > 0");
    const double steps = 1.0 / (sampling.rate_hz * sampling.time_step_s);
    if (!(std::round(steps) >= 1.0 && std::abs(steps - std::round(steps)) <= rounding * steps))
        throw InputError("", 0, "rate_hz * time_step_s", std::to_string(1.0 / steps),
                         "expected 1 / n: n steps per frame");
    if (steps > most_steps_per_frame)
        throw InputError("", 0, "rate_hz * time_step_s", std::to_string(1.0 / steps),
                         "expected at most 100000 steps per frame");
    return static_cast<int>(std::round(steps));
}

int frames_after_the_first(const MotionSampling& sampling, double length_s, double slack_s, const std::string& file)
{
    if (!(sampling.start_s >= 0.0 && sampling.start_s <= length_s + slack_s))
        throw InputError(file, 0, "start_s", std::to_string(sampling.start_s),
                         "the clip lasts " + std::to_string(length_s) + " s");
    if (!(sampling.duration_s >= 0.0 && sampling.start_s + sampling.duration_s <= length_s + slack_s))
        throw InputError(file, 0, "duration_s", std::to_string(sampling.duration_s),
                         "the clip ends at " + std::to_string(length_s) + " s, " +
                             std::to_string(length_s - sampling.start_s) + " s on");
    const double duration_s = sampling.duration_s > 0.0 ? sampling.duration_s : length_s - sampling.start_s;
    return static_cast<int>(std::floor(duration_s * sampling.rate_hz + rounding));
}

double time_step_for(double rate_hz, double longest_s)
{
    return 1.0 / (rate_hz * std::max(1.0, std::ceil(1.0 / (rate_hz * longest_s) - rounding)));
}

}  // namespace pbs

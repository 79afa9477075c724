#include "pbs/character/clip_match.hpp"

#include "pbs/character/retarget_plan.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace pbs {
namespace {

constexpr double same_rotation_rad = 1e-4;  // of keys in single precision, with margin

bool moves(const Clip& clip, std::size_t joint)
{
    return std::any_of(clip.local.begin(), clip.local.end(), [&](const std::vector<Eigen::Quaterniond>& frame) {
        return clip.local.front()[joint].angularDistance(frame[joint]) > same_rotation_rad;
    });
}

}  // namespace

ClipMatch match_of(const Clip& clip, const Skeleton& skeleton)
{
    std::set<int> followed;
    for (const BoneFollowing& bone : plan_retargeting(clip, skeleton).bones) {
        followed.insert(bone.joint);
        followed.insert(bone.twist_joint);
    }
    ClipMatch match;
    for (std::size_t j = 0; j < clip.joints.size(); ++j) {
        if (!moves(clip, j)) continue;
        ++match.moving;
        if (followed.count(static_cast<int>(j)) > 0)
            ++match.matched;
        else
            match.unmatched.push_back(clip.joints[j]);
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

}  // namespace pbs

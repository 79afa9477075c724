#include "experiments/clips/body_axes.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/nearest_rotation.hpp"

#include <algorithm>
#include <cmath>

namespace pbs {
namespace {

constexpr double least_trunk_angle_deg = 30.0;             // between the two directions of a trunk
constexpr double near_up_deg = 30.0, near_left_deg = 5.0;  // of an axis
constexpr double bent_deg = 15.0;                          // between the halves of a limb that is straight
constexpr double spread_deg = 30.0;                        // between a leg and down
constexpr double forward_deg = 30.0;                       // between an arm and the side, seen from above
constexpr double lowest_arm_deg = 70.0;                    // from the side, in an A pose
constexpr double farthest_trunk_deg = 30.0;                // between clip and body
constexpr double same_rig = 0.1;                           // rms of the joints from the bones over their extent
constexpr double degrees = 180.0 / M_PI;

Vec3 between(const Positions& points, int from, int to)
{
    return from < 0 || to < 0 ? Vec3::Zero() : Vec3(points.row(to) - points.row(from));
}

// The axis of the file that is nearest to a direction, if it is near; otherwise the direction.
Vec3 snapped(const Vec3& direction, double near_deg)
{
    const Vec3 nearest = nearest_axis(direction);
    return angle_deg(direction, nearest) <= near_deg ? nearest : direction.normalized();
}

int lower_end(const BodyJoints& joints, std::size_t side)
{
    return joints.foot[side] >= 0 ? joints.foot[side] : joints.shin[side];
}

bool is_straight(const Positions& points, int above, int middle, int below)
{
    return angle_deg(between(points, above, middle), between(points, middle, below)) <= bent_deg;
}

// Legs that point down and a left side that is one for hips and shoulders.
bool is_upright(const Positions& points, const BodyJoints& joints)
{
    const auto trunk = trunk_directions(points, joints);
    if (!trunk) return false;
    for (std::size_t side = 0; side < 2; ++side)
        if (angle_deg(between(points, joints.thigh[side], lower_end(joints, side)), -trunk->up) > 60.0) return false;
    return between(points, joints.upper_arm[1], joints.upper_arm[0])
               .dot(between(points, joints.thigh[1], joints.thigh[0])) >= 0.0;
}

std::string pose_text(const Positions& points, const BodyJoints& joints)
{
    const auto trunk = trunk_directions(points, joints);
    if (!trunk) return "has no trunk, since joints coincide or lie in one line";
    const auto legs_deg = [&](std::size_t side) {
        return angle_deg(between(points, joints.thigh[side], lower_end(joints, side)), -trunk->up);
    };
    return "has legs that point " + number_text(std::max(legs_deg(0), legs_deg(1)), 3) +
           " degrees away from the trunk's downward direction";
}

// The rotation that carries matched joints onto heads of bones; the identity unless they are the same rig.
Eigen::Matrix3d rotation_of_same_rig(const Positions& rest, const Skeleton& skeleton, const JointMap& map)
{
    std::vector<Vec3> from, to;
    for (std::size_t b = 0; b < map.bones.size(); ++b) {
        if (map.bones[b].joint < 0) continue;
        from.emplace_back(rest.row(map.bones[b].joint));
        to.push_back(skeleton.bones[b].head);
    }
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
    if (from.size() < 4) return rotation;
    const auto centred = [](std::vector<Vec3>& points) {
        Vec3 middle = Vec3::Zero();
        for (const Vec3& point : points) middle += point / static_cast<double>(points.size());
        double square = 0.0;
        for (Vec3& point : points) square += (point -= middle).squaredNorm();
        for (Vec3& point : points) point /= square > 0.0 ? std::sqrt(square) : 1.0;
    };
    centred(from);
    centred(to);
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (std::size_t k = 0; k < from.size(); ++k) covariance += to[k] * from[k].transpose();
    const Eigen::Vector3d singular = covariance.jacobiSvd().singularValues();
    if (singular(1) < 1e-3 * singular(0)) return rotation;  // in one line
    const Eigen::Matrix3d best = nearest_rotation(covariance);
    double square = 0.0;
    for (std::size_t k = 0; k < from.size(); ++k) square += (best * from[k] - to[k]).squaredNorm();
    const bool turned = Eigen::AngleAxisd(best).angle() * degrees > near_left_deg;
    return std::sqrt(square) <= same_rig && turned ? best : rotation;
}

}  // namespace

double angle_deg(const Vec3& a, const Vec3& b)
{
    return std::atan2(a.cross(b).norm(), a.dot(b)) * degrees;
}

Vec3 nearest_axis(const Vec3& direction)
{
    Eigen::Index axis = 0;
    direction.cwiseAbs().maxCoeff(&axis);
    return (direction(axis) < 0.0 ? -1.0 : 1.0) * Vec3::Unit(axis);
}

std::optional<TrunkDirections> trunk_directions(const Positions& points, const BodyJoints& joints)
{
    const int top = joints.neck >= 0 ? joints.neck : joints.head;
    if (top < 0 || joints.thigh[0] < 0 || joints.thigh[1] < 0) return std::nullopt;
    const Vec3 hips = 0.5 * (points.row(joints.thigh[0]) + points.row(joints.thigh[1]));
    const Vec3 up = points.row(top).transpose() - hips, hip_line = between(points, joints.thigh[1], joints.thigh[0]);
    const Vec3 shoulder_line = between(points, joints.upper_arm[1], joints.upper_arm[0]);
    const double extent = (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm(), shortest = 1e-3 * extent;
    if (!(up.norm() > shortest && hip_line.norm() > shortest)) return std::nullopt;
    Vec3 left = hip_line.normalized();
    if (shoulder_line.norm() > shortest) left += shoulder_line.normalized();
    const double angle = angle_deg(up, left);
    if (left.norm() < 0.5 || angle < least_trunk_angle_deg || angle > 180.0 - least_trunk_angle_deg)
        return std::nullopt;
    return TrunkDirections{up.normalized(), left.normalized()};
}

Eigen::Matrix3d body_axes(const TrunkDirections& trunk)
{
    const Vec3 up = snapped(trunk.up, near_up_deg);
    Vec3 left = snapped(trunk.left - trunk.left.dot(up) * up, near_left_deg);
    left = (left - left.dot(up) * up).normalized();
    Eigen::Matrix3d axes;
    axes << left, up, left.cross(up);
    return axes;
}

bool is_t_or_a_pose(const Positions& points, const BodyJoints& joints)
{
    const auto trunk = trunk_directions(points, joints);
    if (!trunk) return false;
    const Eigen::Matrix3d axes = body_axes(*trunk);
    const Vec3 left = axes.col(0), up = axes.col(1);
    for (std::size_t side = 0; side < 2; ++side) {
        const Vec3 leg = between(points, joints.thigh[side], lower_end(joints, side));
        if (leg.isZero(0.0) || angle_deg(leg, -up) > spread_deg) return false;
        if (joints.foot[side] >= 0 && !is_straight(points, joints.thigh[side], joints.shin[side], joints.foot[side]))
            return false;
        if (joints.upper_arm[side] < 0 || joints.forearm[side] < 0) continue;
        const int end = joints.hand[side] >= 0 ? joints.hand[side] : joints.forearm[side];
        const Vec3 arm = between(points, joints.upper_arm[side], end).normalized(),
                   outward = side == 0 ? left : Vec3(-left);
        const double raised = std::asin(std::clamp(arm.dot(up), -1.0, 1.0)) * degrees;
        if (arm.dot(outward) <= 0.0 || raised > 20.0 || raised < -lowest_arm_deg) return false;
        if (angle_deg(arm - arm.dot(up) * up, outward) > forward_deg) return false;
        if (end == joints.hand[side] && !is_straight(points, joints.upper_arm[side], joints.forearm[side], end))
            return false;
    }
    return true;
}

int rest_frame(const Clip& clip, const BodyJoints& joints)
{
    const bool is_known = (joints.neck >= 0 || joints.head >= 0) && lower_end(joints, 0) >= 0 &&
                          lower_end(joints, 1) >= 0 && joints.thigh[0] >= 0 && joints.thigh[1] >= 0;
    if (!is_known || is_t_or_a_pose(clip.zero_pose, joints)) return -1;
    if (is_t_or_a_pose(clip.places.front(), joints)) return 0;
    if (is_upright(clip.zero_pose, joints)) return -1;
    throw InputError(clip.name, 0, "rest pose", "",
                     "cannot be known: the pose without rotations " + pose_text(clip.zero_pose, joints) +
                         " (in clips whose joints have frames along their bones, all offsets lie along one axis), and "
                         "the first frame is neither "
                         "a T nor an A pose: put a T pose in front of the motion, or export the clip with the skin's "
                         "bind pose as .glb");
}

Eigen::Matrix3d axes_of_clip_to_skeleton(const Positions& rest, const Skeleton& skeleton, const JointMap& map)
{
    const auto body = trunk_directions(heads_of(skeleton), map.of_skeleton),
               source = trunk_directions(rest, map.of_clip);
    if (!body || !source) return rotation_of_same_rig(rest, skeleton, map);
    return body_axes(*body) * body_axes(*source).transpose();
}

std::vector<BodySegment> body_segments(const JointMap& map)
{
    const BodyJoints &body = map.of_skeleton, &clip = map.of_clip;
    std::vector<BodySegment> segments = {{"hips", body.thigh[1], body.thigh[0], clip.thigh[1], clip.thigh[0]},
                                         {"chest", body.chest, body.neck, clip.chest, clip.neck},
                                         {"head", body.neck, body.head, clip.neck, clip.head}};
    for (std::size_t s = 0; s < 2; ++s) {
        const std::string side = s == 0 ? "left " : "right ";
        segments.push_back(
            {side + "upper arm", body.upper_arm[s], body.forearm[s], clip.upper_arm[s], clip.forearm[s]});
        segments.push_back({side + "forearm", body.forearm[s], body.hand[s], clip.forearm[s], clip.hand[s]});
        segments.push_back({side + "thigh", body.thigh[s], body.shin[s], clip.thigh[s], clip.shin[s]});
        segments.push_back({side + "shin", body.shin[s], body.foot[s], clip.shin[s], clip.foot[s]});
    }
    std::erase_if(segments, [](const BodySegment& segment) {
        return segment.from_bone < 0 || segment.to_bone < 0 || segment.from_joint < 0 || segment.to_joint < 0;
    });
    return segments;
}

Positions heads_of(const Skeleton& skeleton)
{
    return posed_heads(skeleton, Pose(skeleton.bones.size(), Eigen::Isometry3d::Identity()));
}

Positions posed_heads(const Skeleton& skeleton, const Pose& pose)
{
    Positions heads(static_cast<Eigen::Index>(pose.size()), 3);
    for (std::size_t b = 0; b < pose.size(); ++b)
        heads.row(static_cast<Eigen::Index>(b)) = pose[b] * skeleton.bones[b].head;
    return heads;
}

void check_trunk(const Clip& clip, const JointMap& map, const Positions& body_places, const Positions& clip_places)
{
    const auto body = trunk_directions(body_places, map.of_skeleton),
               source = trunk_directions(clip_places, map.of_clip);
    if (!body || !source) return;
    const auto hip_line = [](const Positions& points, const BodyJoints& joints) {
        return between(points, joints.thigh[1], joints.thigh[0]);
    };
    const double trunk_deg = angle_deg(body->up, source->up);
    const double hips_deg = angle_deg(hip_line(body_places, map.of_skeleton), hip_line(clip_places, map.of_clip));
    for (const auto& [name, deg] :
         {std::pair<std::string, double>{"from the hips to the neck", trunk_deg}, {"from hip to hip", hips_deg}})
        if (deg > farthest_trunk_deg)
            throw InputError(clip.name, 0, "direction " + name,
                             number_text(deg, 3) + " degrees between the clip and the body",
                             "expected at most 30 in the first frame: the rest pose of the clip or the bind pose of "
                             "the model is not the one "
                             "that its rotations are measured from; export either of them again in a T pose");
}

}  // namespace pbs

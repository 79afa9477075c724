// Where a body's left, up and front are, from two directions: from the hips to the neck, and from the right to the left
// hips and shoulders. Clips and models differ in which way is up (y in most clips, z in Blender's) and in which way the
// body faces (z, but -z in VRM 0), and exporters differ in the frames of their joints (along the bones in Maya's). So
// the rest pose of a clip is found here, and the rotation that carries its axes into those of another body.
#pragma once

#include "experiments/clips/clip.hpp"

#include <optional>
#include <string>
#include <vector>

namespace pbs {

// The directions of a body, of unit length; left is not perpendicular to up.
struct TrunkDirections {
    Vec3 up, left;
};

// points: of each joint, #joints x 3. Nothing where joints of the trunk are unknown or coincide, or where the two
// directions are parallel within 30 degrees.
std::optional<TrunkDirections> trunk_directions(const Positions& points, const BodyJoints& joints);

// Columns left, up and front. A direction near an axis of the file is that axis, since files are exported along axes
// and bodies lean: up within 30 degrees, left within 5.
Eigen::Matrix3d body_axes(const TrunkDirections& trunk);

// The axis of the file, positive or negative, that is nearest to a direction.
Vec3 nearest_axis(const Vec3& direction);

// Straight legs below the trunk, and straight arms at its sides that hang by at most 70 degrees (a T or A pose). Knees
// and elbows are bent by at most 15 degrees, as actors stand. Limbs whose joints are unknown do not count; no legs are
// no such pose.
bool is_t_or_a_pose(const Positions& points, const BodyJoints& joints);

// The pose from which the turns of a clip are measured: its zero pose if that is a T or A pose; else its first frame if
// that is one; else the zero pose if its legs point down and its left and right are one (a pose that differs from a T
// pose, but a body's). -1: the zero pose, 0: the first frame. An InputError says why neither can be believed: in clips
// whose joints have frames along their bones (Maya, LAFAN1, Rokoko) all offsets lie along one axis. Where the parts of
// the body are unknown, it is the zero pose.
int rest_frame(const Clip& clip, const BodyJoints& joints);

// From the axes of the clip's body to those of the skeleton's. Where the parts of either body are unknown, the rotation
// that carries the joints onto the bones' heads if they are the same rig in other axes (four joints or more, within 10
// % of their extent), else none.
Eigen::Matrix3d axes_of_clip_to_skeleton(const Positions& rest, const Skeleton& skeleton, const JointMap& map);

// A part of a body from one joint to another, in the skeleton and in the clip.
struct BodySegment {
    std::string part;
    int from_bone = -1, to_bone = -1, from_joint = -1, to_joint = -1;
};

// Hips (from the right to the left thigh), chest (from chest to neck), head (from neck to head), and the halves of the
// limbs, as far as their joints are known in both.
std::vector<BodySegment> body_segments(const JointMap& map);

Positions heads_of(const Skeleton& skeleton);                       // #bones x 3
Positions posed_heads(const Skeleton& skeleton, const Pose& pose);  // #bones x 3

// An InputError where the trunk or the hips of the posed body point more than 30 degrees away from the clip's.
// clip_places: of the joints at that time, in the axes of the skeleton.
void check_trunk(const Clip& clip, const JointMap& map, const Positions& body_places, const Positions& clip_places);

// Angle between two directions [deg]; 0 where one of them is no direction.
double angle_deg(const Vec3& a, const Vec3& b);

}  // namespace pbs

// How each vertex is bound to the skeleton in rest pose: its nearest bone and its projection on that bone.
#pragma once

#include "pbs/skinning/pose.hpp"

namespace pbs {

// One entry per vertex of the bound mesh.
struct BoneBinding {
    std::vector<int> bone;      // nearest bone of each vertex, #V; the first of equals
    Eigen::VectorXd parameter;  // position along the bone, (v - s).(d - s) / |d - s|^2, not clamped, #V
    Positions rest_point;       // projection on the bone's segment [m], #V x 3: a material point of the bone
    Eigen::VectorXd distance;   // d_i = |v_i - rest_point_i| [m], #V
};

// rest: rest positions [m], #V x 3. A bone without length is the point at its head, with parameter 0. InputError where the skeleton has no
// bone.
BoneBinding bind_to_nearest_bone(const Positions& rest, const Skeleton& skeleton);

// The projection points q_i carried by their posed bones [m], #V x 3. The pose has every bone of the binding (unchecked).
Positions posed_bind_points(const BoneBinding& binding, const Pose& pose);

// The other reading of "its projection on the nearest bone" (Sec. 3.6): positions [m], #V x 3, projected anew on their posed bones'
// segments.
Positions reprojected_bind_points(const BoneBinding& binding, const Skeleton& skeleton, const Pose& pose, const Positions& positions);

}  // namespace pbs

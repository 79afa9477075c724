#include "pbs/skinning/weights.hpp"

#include "pbs/geometry/input_error.hpp"

#include <algorithm>

namespace pbs {
namespace {

struct Projection {
    double parameter;  // along the bone, not clamped
    Vec3 point;        // on the bone's segment [m]
    double distance;   // [m]
};

// A bone without length is the point at its head, which is its near end too: parameter 0.
Projection project_on_bone(const Vec3& vertex, const Bone& bone)
{
    const Vec3 axis = bone.tail - bone.head;
    const double length_squared = axis.squaredNorm();
    const double parameter = length_squared > 0.0 ? (vertex - bone.head).dot(axis) / length_squared : 0.0;
    const Vec3 point = parameter >= 1.0 ? bone.tail : Vec3(bone.head + std::max(parameter, 0.0) * axis);
    return {parameter, point, (vertex - point).norm()};
}

}  // namespace

BoneBinding bind_to_nearest_bone(const Positions& rest, const Skeleton& skeleton)
{
    if (skeleton.bones.empty()) throw InputError("skeleton", 0, "bones", "0", "expected at least one bone");
    BoneBinding binding{std::vector<int>(rest.rows()), Eigen::VectorXd(rest.rows()), Positions(rest.rows(), 3),
                        Eigen::VectorXd(rest.rows())};
    for (Eigen::Index i = 0; i < rest.rows(); ++i) {
        const Vec3 vertex = rest.row(i);
        int nearest = 0;
        Projection best = project_on_bone(vertex, skeleton.bones[0]);
        for (int j = 1; j < static_cast<int>(skeleton.bones.size()); ++j) {
            const Projection candidate = project_on_bone(vertex, skeleton.bones[j]);
            if (candidate.distance < best.distance) {
                nearest = j;
                best = candidate;
            }
        }
        binding.bone[i] = nearest;
        binding.parameter(i) = best.parameter;
        binding.rest_point.row(i) = best.point;
        binding.distance(i) = best.distance;
    }
    return binding;
}

Positions posed_bind_points(const BoneBinding& binding, const Pose& pose)
{
    Positions points(binding.rest_point.rows(), 3);
    for (Eigen::Index i = 0; i < points.rows(); ++i) points.row(i) = pose[binding.bone[i]] * Vec3(binding.rest_point.row(i));
    return points;
}

Positions reprojected_bind_points(const BoneBinding& binding, const Skeleton& skeleton, const Pose& pose, const Positions& positions)
{
    Positions points(positions.rows(), 3);
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
        const int j = binding.bone[i];
        const Bone posed{"", -1, pose[j] * skeleton.bones[j].head, pose[j] * skeleton.bones[j].tail};
        points.row(i) = project_on_bone(positions.row(i), posed).point;
    }
    return points;
}

}  // namespace pbs

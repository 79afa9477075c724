#include "pbs/skinning/blend.hpp"

#include <algorithm>

namespace pbs {
namespace {

// The unit dual quaternion real + eps dual of a rigid transform.
struct DualQuaternion {
    Eigen::Vector4d real, dual;  // coefficients x, y, z, w
};

DualQuaternion dual_quaternion_of(const Eigen::Isometry3d& transform)
{
    const Eigen::Quaterniond rotation = Eigen::Quaterniond(transform.linear()).normalized();
    const Vec3 half = 0.5 * transform.translation();
    return {rotation.coeffs(), (Eigen::Quaterniond(0.0, half.x(), half.y(), half.z()) * rotation).coeffs()};
}

// Rotation and translation of a blended, not yet unit, dual quaternion (Kavan 2007, Algorithm 1).
Vec3 transform_point(const DualQuaternion& blended, const Vec3& point)
{
    const double length = blended.real.norm();
    const Vec3 r = blended.real.head<3>() / length, d = blended.dual.head<3>() / length;
    const double r_w = blended.real(3) / length, d_w = blended.dual(3) / length;
    return point + 2.0 * r.cross(r.cross(point) + r_w * point) + 2.0 * (r_w * d - d_w * r + r.cross(d));
}

// q and -q are the same rotation: every bone is taken on the side of the vertex's heaviest bone.
DualQuaternion blend(const std::vector<DualQuaternion>& bones, const Weights& weights, int vertex)
{
    const int first = weights.first[vertex], last = weights.first[vertex + 1];
    const auto heaviest = std::max_element(weights.weight.begin() + first, weights.weight.begin() + last) - weights.weight.begin();
    const Eigen::Vector4d& pivot = bones[weights.bone[heaviest]].real;
    DualQuaternion sum{Eigen::Vector4d::Zero(), Eigen::Vector4d::Zero()};
    for (int entry = first; entry < last; ++entry) {
        const DualQuaternion& bone = bones[weights.bone[entry]];
        const double weight = bone.real.dot(pivot) < 0.0 ? -weights.weight[entry] : weights.weight[entry];
        sum.real += weight * bone.real;
        sum.dual += weight * bone.dual;
    }
    return sum;
}

}  // namespace

void linear_blend_skinning(const Positions& rest, const Weights& weights, const Pose& pose, Positions& posed)
{
    posed.resize(rest.rows(), 3);
    for (int i = 0; i < rest.rows(); ++i) {
        const Vec3 vertex = rest.row(i);
        Vec3 sum = Vec3::Zero();
        for (int entry = weights.first[i]; entry < weights.first[i + 1]; ++entry)
            sum += weights.weight[entry] * (pose[weights.bone[entry]] * vertex);  // Eq. 1
        posed.row(i) = sum;
    }
}

void dual_quaternion_skinning(const Positions& rest, const Weights& weights, const Pose& pose, Positions& posed)
{
    std::vector<DualQuaternion> bones;
    for (const Eigen::Isometry3d& transform : pose) bones.push_back(dual_quaternion_of(transform));
    posed.resize(rest.rows(), 3);
    for (int i = 0; i < rest.rows(); ++i) posed.row(i) = transform_point(blend(bones, weights, i), rest.row(i));
}

}  // namespace pbs

#include "pbs/rig/rig_pose.hpp"

#include "pbs/geometry/input_error.hpp"

#include <algorithm>

namespace pbs {
namespace {

// The keys around a time, and how far it lies between them, 0 to 1.
struct Between {
    std::size_t before = 0, after = 0;
    double share = 0.0, distance_s = 0.0;
};

Between keys_around(const KeyTrack& track, double time_s)
{
    const auto& times_s = track.times_s;
    const auto after = static_cast<std::size_t>(std::upper_bound(times_s.begin(), times_s.end(), time_s) - times_s.begin());
    if (after == 0) return {};
    if (after == times_s.size()) return {after - 1, after - 1};
    const double distance_s = times_s[after] - times_s[after - 1];
    return {after - 1, after, (time_s - times_s[after - 1]) / distance_s, distance_s};
}

// glTF 2.0, Appendix C.4, of keys that hold in-tangent, value and out-tangent.
Eigen::Vector4d cubic_value(const KeyTrack& track, const Between& at)
{
    const double t = at.share, t2 = t * t, t3 = t2 * t;
    const auto& values = track.values;
    return (2.0 * t3 - 3.0 * t2 + 1.0) * values[3 * at.before + 1] + at.distance_s * (t3 - 2.0 * t2 + t) * values[3 * at.before + 2] +
           (3.0 * t2 - 2.0 * t3) * values[3 * at.after + 1] + at.distance_s * (t3 - t2) * values[3 * at.after];
}

Eigen::Quaterniond quaternion(const Eigen::Vector4d& xyzw)
{
    return Eigen::Quaterniond(xyzw).normalized();
}

NodeTransform moved(const NodeTransform& rest, const NodeTracks& tracks, double time_s)
{
    NodeTransform transform = rest;
    if (tracks.translation) transform.translation = vector_at(*tracks.translation, time_s);
    if (tracks.rotation) transform.rotation = rotation_at(*tracks.rotation, time_s);
    if (tracks.scale) transform.scale = vector_at(*tracks.scale, time_s);
    return transform;
}

}  // namespace

Eigen::Affine3d NodeTransform::affine() const
{
    if (matrix) return *matrix;
    return Eigen::Translation3d(translation) * rotation * Eigen::Scaling(scale);
}

const RigAnimation* find_animation(const Rig& rig, const std::string& name)
{
    if (name.empty()) return rig.animations.empty() ? nullptr : &rig.animations.front();
    std::string names;
    for (const RigAnimation& animation : rig.animations) {
        if (animation.name == name) return &animation;
        names += (names.empty() ? "" : ", ") + animation.name;
    }
    throw InputError(rig.file, 0, "animation", name, names.empty() ? "the file has no animation" : "expected one of " + names);
}

Vec3 vector_at(const KeyTrack& track, double time_s)
{
    const Between at = keys_around(track, time_s);
    if (track.interpolation == Interpolation::cubic_spline) return cubic_value(track, at).head<3>();
    const Vec3 before = track.values[at.before].head<3>();
    if (track.interpolation == Interpolation::step) return before;
    return (1.0 - at.share) * before + at.share * track.values[at.after].head<3>();
}

Eigen::Quaterniond rotation_at(const KeyTrack& track, double time_s)
{
    const Between at = keys_around(track, time_s);
    if (track.interpolation == Interpolation::cubic_spline) return quaternion(cubic_value(track, at));
    const Eigen::Quaterniond before = quaternion(track.values[at.before]);
    if (track.interpolation == Interpolation::step) return before;
    return before.slerp(at.share, quaternion(track.values[at.after])).normalized();
}

std::vector<Eigen::Affine3d> node_transforms(const Rig& rig, const RigAnimation* animation, double time_s)
{
    std::vector<Eigen::Affine3d> transforms;
    for (const RigNode& node : rig.nodes) transforms.push_back(node.rest.affine());
    if (animation)
        for (const NodeTracks& tracks : animation->nodes)
            transforms[tracks.node] = moved(rig.nodes[tracks.node].rest, tracks, time_s).affine();
    for (std::size_t n = 0; n < rig.nodes.size(); ++n)
        if (const int parent = rig.nodes[n].parent; parent >= 0) transforms[n] = transforms[parent] * transforms[n];
    return transforms;
}

Positions skinned_points(const RigMesh& mesh, const std::vector<Eigen::Affine3d>& node_transforms)
{
    Positions moved(mesh.points.rows(), 3);
    if (mesh.joints.empty()) {
        for (Eigen::Index p = 0; p < mesh.points.rows(); ++p) moved.row(p) = node_transforms[mesh.node] * Vec3(mesh.points.row(p));
        return moved;
    }
    std::vector<Eigen::Affine3d> from_mesh;  // W_j B_j^-1
    for (const SkinJoint& joint : mesh.joints) from_mesh.push_back(node_transforms[joint.node] * joint.inverse_bind);
    moved.setZero();
    for (int p = 0; p < mesh.skin.vertices(); ++p)
        for (int e = mesh.skin.first[p]; e < mesh.skin.first[p + 1]; ++e)
            moved.row(p) += mesh.skin.weight[e] * (from_mesh[mesh.skin.bone[e]] * Vec3(mesh.points.row(p))).transpose();
    return moved;
}

}  // namespace pbs

#include "experiments/rigs/rigged_body.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/skinning/blend.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

namespace pbs {
namespace {

constexpr double same_scale = 1e-3;  // relative; scales of an animation that differ less are rounding of the exporter
constexpr double same_bind_pose = 1e-3;  // relative to a joint's matrix, single precision with some products

// The keys around a time, and how far it lies between them, 0 to 1.
struct Between {
    std::size_t before = 0, after = 0;
    double share = 0.0, distance_s = 0.0;
};

Between keys_around(const KeyTrack& track, double time_s)
{
    const auto& times_s = track.times_s;
    const auto after =
        static_cast<std::size_t>(std::upper_bound(times_s.begin(), times_s.end(), time_s) - times_s.begin());
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
    return (2.0 * t3 - 3.0 * t2 + 1.0) * values[3 * at.before + 1] +
           at.distance_s * (t3 - 2.0 * t2 + t) * values[3 * at.before + 2] +
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

FbxPlacement placed(const RigNode& node, const NodeTracks* tracks, double time_s, const FbxPlacement& parent)
{
    if (node.fbx) return placed_below(parent, tracks ? transform_at(*node.fbx, tracks->fbx, time_s) : *node.fbx);
    FbxPlacement placement;
    placement.world = parent.world * (tracks ? moved(node.rest, *tracks, time_s) : node.rest).affine();
    return placement;
}

bool moves_node(const NodeTracks& tracks)
{
    return tracks.morph_weights.empty() || tracks.translation || tracks.rotation || tracks.scale;
}

// Nodes that move meshes: joints of skins, and nodes that an animation moves.
std::set<int> moving_nodes(const Rig& rig)
{
    std::set<int> nodes;
    for (const RigMesh& mesh : rig.meshes)
        for (const SkinJoint& joint : mesh.joints) nodes.insert(joint.node);
    for (const RigAnimation& animation : rig.animations)
        for (const NodeTracks& tracks : animation.nodes)
            if (moves_node(tracks)) nodes.insert(tracks.node);
    return nodes;
}

// The node itself or the nearest one above it that moves; -1: none.
int carrier_of(int node, const std::set<int>& moving, const Rig& rig)
{
    while (node >= 0 && moving.count(node) == 0) node = rig.nodes[node].parent;
    return node;
}

double scale_of(const Eigen::Affine3d& affine)
{
    return std::cbrt(std::abs(affine.linear().determinant()));
}

Weights all_on_first_joint(Eigen::Index points)
{
    Weights skin;
    for (int p = 0; p <= points; ++p) skin.first.push_back(p);
    skin.bone.assign(static_cast<std::size_t>(points), 0);
    skin.weight.assign(static_cast<std::size_t>(points), 1.0);
    return skin;
}

// A mesh without a skin as one with a single joint, its carrier.
RigMesh carried_by(int carrier, RigMesh mesh, const std::vector<Eigen::Affine3d>& rest)
{
    mesh.joints = {{carrier, rest[carrier].inverse() * rest[mesh.node]}};
    mesh.skin = all_on_first_joint(mesh.points.rows());
    return mesh;
}

std::vector<RigMesh> moved_meshes(const Rig& rig, const std::vector<Eigen::Affine3d>& rest,
                                  std::vector<std::string>& remarks)
{
    const std::set<int> moving = moving_nodes(rig);
    std::vector<RigMesh> meshes;
    for (const RigMesh& mesh : rig.meshes) {
        const int carrier = mesh.joints.empty() ? carrier_of(mesh.node, moving, rig) : -1;
        if (!mesh.joints.empty())
            meshes.push_back(mesh);
        else if (carrier >= 0 && !(scale_of(rest[carrier]) > 0.0))
            remarks.push_back("mesh " + mesh.name + " is left out: its node " + rig.nodes[carrier].name +
                              " has scale 0 at rest");
        else if (carrier >= 0)
            meshes.push_back(carried_by(carrier, mesh, rest));
        else if (moving.empty() || (!mesh.morphs.displacements.empty() && scale_of(rest[mesh.node]) > 0.0))
            meshes.push_back(carried_by(mesh.node, mesh, rest));
        else
            remarks.push_back("mesh " + mesh.name + " is moved by no joint; it is left out");
    }
    std::stable_sort(meshes.begin(), meshes.end(),
                     [](const RigMesh& a, const RigMesh& b) { return a.points.rows() > b.points.rows(); });
    return meshes;
}

// The joint of a mesh that comes first in the tree: no other one is above it.
const SkinJoint& root_joint(const RigMesh& mesh)
{
    return *std::ranges::min_element(mesh.joints, {}, &SkinJoint::node);
}

// From the mesh's coordinates to rest space: by a joint whose bind pose is known from a larger mesh, or else by its own
// root joint.
Eigen::Affine3d mesh_to_rest(const RigMesh& mesh, const RigBinding& binding, const std::vector<Eigen::Affine3d>& rest)
{
    for (const SkinJoint& joint : mesh.joints)
        if (const auto known = binding.bind.find(joint.node); known != binding.bind.end())
            return known->second * joint.inverse_bind;
    const SkinJoint& root = root_joint(mesh);
    return rest[root.node] * root.inverse_bind;
}

Positions blended(const Positions& points, const Weights& skin, const std::vector<Eigen::Affine3d>& of_joint)
{
    Positions moved = Positions::Zero(points.rows(), 3);
    for (int p = 0; p < skin.vertices(); ++p)
        for (int e = skin.first[p]; e < skin.first[p + 1]; ++e)
            moved.row(p) += skin.weight[e] * (of_joint[skin.bone[e]] * Vec3(points.row(p))).transpose();
    return moved;
}

// The size of a pose over that of the bind pose: that of the joint with as much weight on smaller joints as on larger
// ones, for a single one may be scaled for its looks. A node that scales them all, as converters put it above a model,
// may be below a root joint that moves no point.
double size_of_pose(const Rig& rig, const RigAnimation* animation, const RigBinding& binding)
{
    const std::vector<Eigen::Affine3d> pose = node_transforms(rig, animation, animation ? animation->start_s : 0.0);
    std::map<int, double> weight;  // of each joint
    for (const RigMesh& mesh : binding.meshes)
        for (std::size_t e = 0; e < mesh.skin.bone.size(); ++e)
            weight[mesh.joints[mesh.skin.bone[e]].node] += mesh.skin.weight[e];
    std::vector<std::tuple<double, int, double>> sizes;  // of a joint, the joint and its weight
    double rest = 0.0;
    for (const auto& [node, own] : weight) {
        sizes.emplace_back(scale_of(pose[node]) / scale_of(binding.bind.at(node)), node, own);
        rest += 0.5 * own;
    }
    std::ranges::sort(sizes);
    std::size_t middle = 0;
    while (middle + 1 < sizes.size() && (rest -= std::get<2>(sizes[middle])) > 0.0) ++middle;
    const double size = std::get<0>(sizes[middle]);
    if (!(size > 0.0 && std::isfinite(size)))
        throw InputError(rig.file, 0, "scale of " + rig.nodes[std::get<1>(sizes.front())].name, number_text(size),
                         "expected a scale that is not zero");
    return std::abs(size - 1.0) <= same_scale ? 1.0 : size;
}

// With scales as linear blending has them, and by dual quaternions of the rotations and translations.
Positions blended_by_dual_quaternions(const Positions& points, const Weights& skin,
                                      const std::vector<Eigen::Affine3d>& from_mesh)
{
    Pose pose;
    std::vector<Eigen::Affine3d> scales;
    for (const Eigen::Affine3d& joint : from_mesh) {
        Eigen::Matrix3d rotation, scale;
        joint.computeRotationScaling(&rotation, &scale);
        pose.push_back(Eigen::Translation3d(joint.translation()) * Eigen::Quaterniond(rotation));
        scales.emplace_back(scale);
    }
    Positions moved;
    dual_quaternion_skinning(blended(points, skin, scales), skin, pose, moved);
    return moved;
}

void add_bind_pose(const RigMesh& mesh, const std::vector<Eigen::Affine3d>& rest, RigBinding& binding)
{
    const Eigen::Affine3d to_rest = mesh_to_rest(mesh, binding, rest);
    int contradictions = 0;
    for (const SkinJoint& joint : mesh.joints) {
        const Eigen::Affine3d bind = to_rest * joint.inverse_bind.inverse();
        const auto [known, added] = binding.bind.emplace(joint.node, bind);
        contradictions += !added && !known->second.isApprox(bind, same_bind_pose);
    }
    if (contradictions > 0)
        binding.remarks.push_back(
            "mesh " + mesh.name + " was bound to " + std::to_string(contradictions) + " of " +
            std::to_string(mesh.joints.size()) +
            " joints in another pose than a larger mesh; it was brought into the larger mesh's pose");
}

}  // namespace

Eigen::Affine3d NodeTransform::affine() const
{
    if (matrix) return *matrix;
    return Eigen::Translation3d(translation) * rotation * Eigen::Scaling(scale);
}

void RigLook::put(Eigen::Index first_point, Eigen::Index column, const decltype(numbers)& rows)
{
    const Eigen::Index points = std::max(numbers.rows(), first_point + rows.rows()),
                       columns = std::max(numbers.cols(), column + rows.cols());
    numbers.conservativeResizeLike(decltype(numbers)::Zero(points, columns));
    numbers.block(first_point, column, rows.rows(), rows.cols()) =
        rows.unaryExpr([](float x) { return std::isfinite(x) ? x : 0.0F; });
}

void RigLook::append(const RigLook& other, Eigen::Index points, Eigen::Index triangles)
{
    put(points, 0, other.numbers);
    material.resize(static_cast<std::size_t>(triangles), -1);
    material.insert(material.end(), other.material.begin(), other.material.end());
}

const RigAnimation* find_animation(const Rig& rig, const std::string& name)
{
    if (name.empty()) return rig.animations.empty() ? nullptr : &rig.animations.front();
    std::string names;
    for (const RigAnimation& animation : rig.animations) {
        if (animation.name == name) return &animation;
        names += (names.empty() ? "" : ", ") + animation.name;
    }
    throw InputError(rig.file, 0, "animation", name,
                     names.empty() ? "the file has no animation" : "expected one of " + names);
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
    std::vector<const NodeTracks*> tracks_of(rig.nodes.size());
    if (animation)
        for (const NodeTracks& tracks : animation->nodes) tracks_of[tracks.node] = &tracks;
    std::vector<FbxPlacement> placements;
    for (std::size_t n = 0; n < rig.nodes.size(); ++n) {
        const RigNode& node = rig.nodes[n];
        placements.push_back(
            placed(node, tracks_of[n], time_s, node.parent < 0 ? FbxPlacement{} : placements[node.parent]));
    }
    std::vector<Eigen::Affine3d> transforms;
    for (const FbxPlacement& placement : placements) transforms.push_back(placement.world);
    return transforms;
}

bool moves_nodes(const RigAnimation& animation)
{
    return std::ranges::any_of(animation.nodes, moves_node);
}

Positions morphed_points(const RigMesh& mesh, const RigAnimation* animation, double time_s)
{
    Positions points = mesh.points;
    if (!animation || mesh.morphs.displacements.empty()) return points;
    for (const NodeTracks& tracks : animation->nodes) {
        if (tracks.node != mesh.node) continue;
        for (std::size_t k = 0; k < tracks.morph_weights.size(); ++k)
            points += (vector_at(tracks.morph_weights[k], time_s).x() - mesh.morphs.rest_weights[k]) *
                      mesh.morphs.displacements[k];
    }
    return points;
}

Positions skinned_points(const RigMesh& mesh, const std::vector<Eigen::Affine3d>& node_transforms)
{
    return skinned_points(mesh, node_transforms, mesh.points);
}

Positions skinned_points(const RigMesh& mesh, const std::vector<Eigen::Affine3d>& node_transforms,
                         const Positions& points)
{
    Positions moved(points.rows(), 3);
    if (mesh.joints.empty()) {
        for (Eigen::Index p = 0; p < points.rows(); ++p)
            moved.row(p) = node_transforms[mesh.node] * Vec3(points.row(p));
        return moved;
    }
    std::vector<Eigen::Affine3d> from_mesh;  // W_j B_j^-1
    for (const SkinJoint& joint : mesh.joints) from_mesh.push_back(node_transforms[joint.node] * joint.inverse_bind);
    moved = blended(points, mesh.skin, from_mesh);
    if (mesh.dual_quaternion_share.empty()) return moved;
    const Eigen::Map<const Eigen::VectorXd> share(mesh.dual_quaternion_share.data(), moved.rows());
    return moved + share.asDiagonal() * (blended_by_dual_quaternions(points, mesh.skin, from_mesh) - moved);
}

RigBinding bind_rig(const Rig& rig, const RigAnimation* animation, double scale)
{
    const std::vector<Eigen::Affine3d> rest = node_transforms(rig, nullptr, 0.0);
    RigBinding binding;
    binding.metres_per_unit = scale * rig.unit_m;
    binding.meshes = moved_meshes(rig, rest, binding.remarks);
    if (binding.meshes.empty()) throw InputError(rig.file, 0, "meshes", "", "expected a mesh that a joint moves");
    for (const RigMesh& mesh : binding.meshes) add_bind_pose(mesh, rest, binding);

    const double size = size_of_pose(rig, animation, binding);
    for (auto& [node, bind] : binding.bind) bind = Eigen::Scaling(size * binding.metres_per_unit) * bind;
    return binding;
}

Positions rest_points(const RigMesh& mesh, const RigBinding& binding)
{
    std::vector<Eigen::Affine3d> to_rest;
    for (const SkinJoint& joint : mesh.joints) to_rest.push_back(binding.bind.at(joint.node) * joint.inverse_bind);
    return blended(mesh.points, mesh.skin, to_rest);
}

}  // namespace pbs

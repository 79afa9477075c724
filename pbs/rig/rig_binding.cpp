#include "pbs/rig/rig_binding.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/number_text.hpp"
#include "pbs/rig/rig_pose.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace pbs {
namespace {

constexpr double same_scale = 1e-3;      // relative; scales of an animation that differ less are rounding of the exporter
constexpr double same_bind_pose = 1e-3;  // relative to a joint's matrix, single precision with some products

// Nodes that move meshes: joints of skins, and nodes that an animation moves.
std::set<int> moving_nodes(const Rig& rig)
{
    std::set<int> nodes;
    for (const RigMesh& mesh : rig.meshes)
        for (const SkinJoint& joint : mesh.joints) nodes.insert(joint.node);
    for (const RigAnimation& animation : rig.animations)
        for (const NodeTracks& tracks : animation.nodes) nodes.insert(tracks.node);
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

std::vector<RigMesh> moved_meshes(const Rig& rig, const std::vector<Eigen::Affine3d>& rest, std::vector<std::string>& remarks)
{
    const std::set<int> moving = moving_nodes(rig);
    std::vector<RigMesh> meshes;
    for (const RigMesh& mesh : rig.meshes) {
        const int carrier = mesh.joints.empty() ? carrier_of(mesh.node, moving, rig) : -1;
        if (!mesh.joints.empty())
            meshes.push_back(mesh);
        else if (carrier >= 0 && !(scale_of(rest[carrier]) > 0.0))
            remarks.push_back("mesh " + mesh.name + " is left out: its node " + rig.nodes[carrier].name + " has scale 0 at rest");
        else if (carrier >= 0)
            meshes.push_back(carried_by(carrier, mesh, rest));
        else if (moving.empty())
            meshes.push_back(carried_by(mesh.node, mesh, rest));
        else
            remarks.push_back("mesh " + mesh.name + " is moved by no joint; it is left out");
    }
    std::stable_sort(meshes.begin(), meshes.end(), [](const RigMesh& a, const RigMesh& b) { return a.points.rows() > b.points.rows(); });
    return meshes;
}

// The joint of a mesh that comes first in the tree: no other one is above it.
const SkinJoint& root_joint(const RigMesh& mesh)
{
    return *std::min_element(mesh.joints.begin(), mesh.joints.end(),
                             [](const SkinJoint& a, const SkinJoint& b) { return a.node < b.node; });
}

// From the mesh's coordinates to rest space: by a joint whose bind pose is known from a larger mesh, or else by its own root joint.
Eigen::Affine3d mesh_to_rest(const RigMesh& mesh, const RigBinding& binding, const std::vector<Eigen::Affine3d>& rest)
{
    for (const SkinJoint& joint : mesh.joints)
        if (const auto known = binding.bind.find(joint.node); known != binding.bind.end()) return known->second * joint.inverse_bind;
    const SkinJoint& root = root_joint(mesh);
    return rest[root.node] * root.inverse_bind;
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
        binding.remarks.push_back("mesh " + mesh.name + " was bound to " + std::to_string(contradictions) + " of " +
                                  std::to_string(mesh.joints.size()) +
                                  " joints in another pose than a larger mesh; it was brought into the larger mesh's pose");
}

}  // namespace

RigBinding bind_rig(const Rig& rig, const RigAnimation* animation, double scale)
{
    const std::vector<Eigen::Affine3d> rest = node_transforms(rig, nullptr, 0.0);
    RigBinding binding;
    binding.metres_per_unit = scale * rig.unit_m;
    binding.meshes = moved_meshes(rig, rest, binding.remarks);
    if (binding.meshes.empty()) throw InputError(rig.file, 0, "meshes", "", "expected a mesh that a joint moves");
    for (const RigMesh& mesh : binding.meshes) add_bind_pose(mesh, rest, binding);

    double size = 1.0;
    if (animation) {
        const int root = root_joint(binding.meshes.front()).node;
        const double at_rest = scale_of(rest[root]), at_start = scale_of(node_transforms(rig, animation, animation->start_s)[root]);
        for (const double scale_of_root : {at_rest, at_start})
            if (!(scale_of_root > 0.0 && std::isfinite(scale_of_root)))
                throw InputError(rig.file, 0, "scale of " + rig.nodes[root].name, number_text(scale_of_root),
                                 "expected a scale that is not zero");
        size = at_start / at_rest;
        if (std::abs(size - 1.0) <= same_scale) size = 1.0;
    }
    for (auto& [node, bind] : binding.bind) bind = Eigen::Scaling(size * binding.metres_per_unit) * bind;
    return binding;
}

Positions rest_points(const RigMesh& mesh, const RigBinding& binding)
{
    std::vector<Eigen::Affine3d> to_rest;
    for (const SkinJoint& joint : mesh.joints) to_rest.push_back(binding.bind.at(joint.node) * joint.inverse_bind);
    Positions points = Positions::Zero(mesh.points.rows(), 3);
    for (int p = 0; p < mesh.skin.vertices(); ++p)
        for (int e = mesh.skin.first[p]; e < mesh.skin.first[p + 1]; ++e)
            points.row(p) += mesh.skin.weight[e] * (to_rest[mesh.skin.bone[e]] * Vec3(mesh.points.row(p))).transpose();
    return points;
}

}  // namespace pbs

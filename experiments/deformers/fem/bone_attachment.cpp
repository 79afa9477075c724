#include "experiments/deformers/fem/bone_attachment.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/tet_volume.hpp"

#include <algorithm>

namespace experiments {
namespace {

// Indices of tets with all four corners inside the capsule: it is convex, so all of the tet is.
std::vector<int> tets_inside(const pbs::TetMesh& mesh, const pbs::BoneCapsule& capsule)
{
    std::vector<int> inside;
    for (int t = 0; t < mesh.tets.rows(); ++t) {
        const auto corners = mesh.tets.row(t);
        if (std::all_of(corners.begin(), corners.end(), [&](int v) { return capsule.contains(mesh.rest.row(v)); })) inside.push_back(t);
    }
    return inside;
}

// The children of the tets that are held in the unrefined character, which are the same parts of the flesh.
BoneAttachment nodes_of_unrefined(const pbs::Character& character, const FemOptions& options)
{
    const BoneAttachment coarse = nodes_attachment(*character.unrefined, options);
    BoneAttachment bones{coarse.capsules, {}, {}, std::vector<int>(character.mesh.rest.rows(), -1), {}, {}};
    const int children = 1 << 3 * character.refinements;
    for (std::size_t k = 0; k < coarse.tet_bone.size(); ++k) {
        const int first = children * coarse.attachment.prescribed_tets[k];
        for (int child = first; child < first + children; ++child) {
            bones.attachment.prescribed_tets.push_back(child);
            bones.tet_bone.push_back(coarse.tet_bone[k]);
            for (const int v : character.mesh.tets.row(child)) bones.vertex_bone[v] = coarse.tet_bone[k];
        }
    }
    return bones;
}

}  // namespace

BoneAttachment bone_attachment(const pbs::Character& character, const FemOptions& options)
{
    switch (options.attachment) {
        case FemAttachment::embedded:
            return embedded_attachment(character, options);
        case FemAttachment::nodes:
            return nodes_attachment(character, options);
        case FemAttachment::bind:
            return bind_attachment(character, options);
    }
    return {};
}

BoneAttachment embedded_attachment(const pbs::Character& character, const FemOptions& options)
{
    BoneAttachment bones{bone_capsules(character, options.core_radius), {}, {}, std::vector<int>(character.mesh.rest.rows(), -1), {}, {}};
    const Eigen::Index per_bone = bones.capsules.empty() ? 0 : sample_points(bones.capsules.front()).rows();
    const auto springs = static_cast<Eigen::Index>(bones.capsules.size()) * per_bone;
    bones.attachment.spring_points.resize(springs, 3);
    bones.attachment.spring_stiffness.resize(springs);
    for (std::size_t j = 0; j < bones.capsules.size(); ++j) {
        const pbs::BoneCapsule& capsule = bones.capsules[j];
        const double density = options.spring_factor * options.young_pa / (capsule.radius_m * capsule.radius_m);
        bones.attachment.spring_points.middleRows(j * per_bone, per_bone) = sample_points(capsule);
        bones.attachment.spring_stiffness.segment(j * per_bone, per_bone)
            .setConstant(density * capsule.volume_m3() / static_cast<double>(per_bone));
        bones.spring_bone.insert(bones.spring_bone.end(), per_bone, static_cast<int>(j));
    }
    return bones;
}

BoneAttachment nodes_attachment(const pbs::Character& character, const FemOptions& options)
{
    if (character.unrefined) return nodes_of_unrefined(character, options);
    const pbs::TetMesh& mesh = character.mesh;
    BoneAttachment bones{bone_capsules(character, options.core_radius), {}, {}, std::vector<int>(mesh.rest.rows(), -1), {}, {}};
    for (int j = 0; j < static_cast<int>(bones.capsules.size()); ++j) {
        int kept = 0;
        for (const int tet : tets_inside(mesh, bones.capsules[j])) {
            const auto corners = mesh.tets.row(tet);
            const auto free_for_bone = [&](int v) { return bones.vertex_bone[v] == -1 || bones.vertex_bone[v] == j; };
            if (!std::all_of(corners.begin(), corners.end(), free_for_bone)) continue;
            for (const int v : corners) bones.vertex_bone[v] = j;
            bones.attachment.prescribed_tets.push_back(tet);
            bones.tet_bone.push_back(j);
            ++kept;
        }
        if (kept == 0)
            throw pbs::InputError(character.name, 0, "bone", character.skeleton.bones[j].name,
                                  "expected four vertices of whole tets inside its capsule that are not in one plane; refine the mesh, "
                                  "raise core_radius or use attachment embedded");
    }
    return bones;
}

BoneAttachment bind_attachment(const pbs::Character& character, const FemOptions& options)
{
    const pbs::TetMesh& mesh = character.mesh;
    constexpr double whole_limb = 1.0;
    BoneAttachment bones{bone_capsules(character, whole_limb), {}, {}, std::vector<int>(mesh.rest.rows(), -1), {}, character.binding};
    bones.attachment.bind_distance = character.binding.distance;
    bones.attachment.bind_stiffness = options.spring_factor * options.young_pa * pbs::lumped_volumes(mesh.rest, mesh.tets);
    for (Eigen::Index v = 0; v < mesh.rest.rows(); ++v) {
        const double radius = bones.capsules[character.binding.bone[v]].radius_m;
        bones.attachment.bind_stiffness(v) /= radius * radius;
    }
    return bones;
}

std::vector<int> gripping_bones(const BoneAttachment& bones, const pbs::Tets& tets, const std::vector<int>& spring_tet)
{
    std::vector<int> gripping = bones.vertex_bone;
    for (std::size_t s = 0; s < spring_tet.size(); ++s)
        if (spring_tet[s] >= 0)
            for (const int v : tets.row(spring_tet[s])) gripping[v] = bones.spring_bone[s];
    return gripping;
}

pbs::Positions spring_targets(const BoneAttachment& bones, const pbs::Pose& pose)
{
    pbs::Positions targets = bones.attachment.spring_points;
    for (Eigen::Index s = 0; s < targets.rows(); ++s)
        targets.row(s) = (pose[bones.spring_bone[s]] * pbs::Vec3(targets.row(s).transpose())).transpose();
    return targets;
}

pbs::Positions vertex_targets(const BoneAttachment& bones, const pbs::Positions& rest, const pbs::Pose& pose)
{
    pbs::Positions targets = rest;
    for (Eigen::Index v = 0; v < rest.rows(); ++v)
        if (bones.vertex_bone[v] >= 0) targets.row(v) = (pose[bones.vertex_bone[v]] * pbs::Vec3(rest.row(v).transpose())).transpose();
    return targets;
}

reference_fem::Targets targets(const BoneAttachment& bones, const pbs::Positions& rest, const pbs::Pose& pose)
{
    return {spring_targets(bones, pose), vertex_targets(bones, rest, pose), pbs::posed_bind_points(bones.binding, pose)};
}

}  // namespace experiments

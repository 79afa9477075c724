#include "experiments/deformers/fem/bone_attachment.hpp"

#include "pbs/character/bone_capsules.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/tet_mesh.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace experiments {
namespace {

// Capsules that hold nothing yet.
BoneAttachment empty_attachment(const pbs::Character& character, double core_radius)
{
    BoneAttachment bones;
    bones.capsules = pbs::bone_capsules(character, core_radius);
    bones.vertex_bone.assign(character.mesh.rest.rows(), -1);
    return bones;
}

// Springs at the sample points of the capsules, each with the stiffness of its share of the volume.
BoneAttachment attached_by(pbs::CapsuleSprings held, const pbs::Character& character, const FemOptions& options)
{
    BoneAttachment bones;
    bones.capsules = std::move(held.capsules);
    bones.attachment.spring_points = std::move(held.springs.points);
    bones.attachment.spring_stiffness = options.young_pa * held.springs.stiffness;
    bones.spring_bone = std::move(held.springs.bone);
    bones.spring_density = std::move(held.density);
    bones.vertex_bone.assign(character.mesh.rest.rows(), -1);
    return bones;
}

pbs::SmoothSpringOptions spring_options(const FemOptions& options)
{
    return {.core_radius = core_radius_of(options),
            .spring_factor = spring_factor_of(options),
            .kernel = options.attachment_kernel,
            .ends = options.attachment_ends,
            .samples = options.attachment_samples};
}

// The children of the tets that are held in the unrefined character, which are the same parts of the flesh.
BoneAttachment nodes_of_unrefined(const pbs::Character& character, const FemOptions& options)
{
    const BoneAttachment coarse = nodes_attachment(*character.unrefined, options);
    BoneAttachment bones = empty_attachment(character, core_radius_of(options));
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
        case FemAttachment::smooth:
            return smooth_attachment(character, options);
        case FemAttachment::embedded:
            return embedded_attachment(character, options);
        case FemAttachment::nodes:
            return nodes_attachment(character, options);
        case FemAttachment::bind:
            return bind_attachment(character, options);
    }
    return {};
}

BoneAttachment smooth_attachment(const pbs::Character& character, const FemOptions& options)
{
    return attached_by(pbs::smooth_springs(character, spring_options(options)), character, options);
}

BoneAttachment embedded_attachment(const pbs::Character& character, const FemOptions& options)
{
    const auto everywhere = [](const pbs::BoneCapsule&, const pbs::Vec3&) { return 1.0; };
    return attached_by(pbs::capsule_springs(character, spring_options(options), everywhere), character, options);
}

BoneAttachment nodes_attachment(const pbs::Character& character, const FemOptions& options)
{
    if (character.unrefined) return nodes_of_unrefined(character, options);
    const pbs::TetMesh& mesh = character.mesh;
    BoneAttachment bones = empty_attachment(character, core_radius_of(options));
    for (int j = 0; j < static_cast<int>(bones.capsules.size()); ++j) {
        int kept = 0;
        for (int tet = 0; tet < mesh.tets.rows(); ++tet) {
            const auto corners = mesh.tets.row(tet);
            // All of a tet is inside if its corners are, for a capsule is convex.
            const auto inside = [&](int v) { return bones.capsules[j].contains(mesh.rest.row(v)); };
            const auto free_for_bone = [&](int v) { return bones.vertex_bone[v] == -1 || bones.vertex_bone[v] == j; };
            if (!std::all_of(corners.begin(), corners.end(), inside)) continue;
            if (!std::all_of(corners.begin(), corners.end(), free_for_bone)) continue;
            for (const int v : corners) bones.vertex_bone[v] = j;
            bones.attachment.prescribed_tets.push_back(tet);
            bones.tet_bone.push_back(j);
            ++kept;
        }
        if (kept == 0)
            throw pbs::InputError(character.name, 0, "bone", character.skeleton.bones[j].name,
                                  "expected four vertices of whole tets inside its capsule that are not in one plane; refine the mesh, "
                                  "raise core_radius or use attachment smooth or embedded");
    }
    return bones;
}

BoneAttachment bind_attachment(const pbs::Character& character, const FemOptions& options)
{
    const pbs::TetMesh& mesh = character.mesh;
    constexpr double whole_limb = 1.0;
    BoneAttachment bones = empty_attachment(character, whole_limb);
    bones.binding = character.binding;
    bones.attachment.bind_distance = character.binding.distance;
    bones.attachment.bind_stiffness = spring_factor_of(options) * options.young_pa * pbs::lumped_volumes(mesh.rest, mesh.tets);
    for (Eigen::Index v = 0; v < mesh.rest.rows(); ++v) {
        const double radius = bones.capsules[character.binding.bone[v]].radius_m;
        bones.attachment.bind_stiffness(v) /= radius * radius;
    }
    return bones;
}

std::vector<int> gripping_bones(const BoneAttachment& bones, const pbs::Tets& tets, const std::vector<int>& spring_tet)
{
    std::map<std::pair<int, int>, double> stiffness;  // of the springs of a vertex and a bone
    for (std::size_t s = 0; s < spring_tet.size(); ++s)
        if (spring_tet[s] >= 0 && bones.spring_density[s] >= gripping_density)
            for (const int v : tets.row(spring_tet[s]))
                stiffness[std::pair(v, bones.spring_bone[s])] += bones.attachment.spring_stiffness(s);

    std::vector<int> gripping = bones.vertex_bone;
    std::vector<double> largest(gripping.size(), 0.0);
    for (const auto& entry : stiffness) {
        const int vertex = entry.first.first, bone = entry.first.second;
        if (entry.second <= largest[vertex]) continue;
        largest[vertex] = entry.second;
        gripping[vertex] = bone;
    }
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

#include "experiments/deformers/fem/bone_attachment.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/tet_mesh.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace experiments {
namespace {

// The children of the tets that are held in the unrefined character, which are the same parts of the flesh.
void hold_children(const BoneAttachment& coarse, const pbs::Character& character, BoneAttachment& bones)
{
    const int children = 1 << 3 * character.refinements;
    for (std::size_t k = 0; k < coarse.tet_bone.size(); ++k)
        for (int child = 0; child < children; ++child) {
            const int tet = children * coarse.attachment.prescribed_tets[k] + child;
            bones.attachment.prescribed_tets.push_back(tet);
            bones.tet_bone.push_back(coarse.tet_bone[k]);
            for (const int v : character.mesh.tets.row(tet)) bones.vertex_bone[v] = coarse.tet_bone[k];
        }
}

void hold_tets(const pbs::Character& character, BoneAttachment& bones)
{
    const pbs::TetMesh& mesh = character.mesh;
    for (int j = 0; j < static_cast<int>(bones.capsules.size()); ++j) {
        // All of a tet is inside if its corners are, for a capsule is convex.
        const auto may_hold = [&](int v) {
            return bones.capsules[j].contains(mesh.rest.row(v)) &&
                   (bones.vertex_bone[v] == -1 || bones.vertex_bone[v] == j);
        };
        for (int tet = 0; tet < mesh.tets.rows(); ++tet) {
            const auto corners = mesh.tets.row(tet);
            if (!std::all_of(corners.begin(), corners.end(), may_hold)) continue;
            for (const int v : corners) bones.vertex_bone[v] = j;
            bones.attachment.prescribed_tets.push_back(tet);
            bones.tet_bone.push_back(j);
        }
        if (bones.tet_bone.empty() || bones.tet_bone.back() != j)
            throw pbs::InputError(
                character.name, 0, "bone", character.skeleton.bones[j].name,
                "expected four vertices of whole tets inside its capsule that are not in one plane; refine the mesh, "
                "raise core_radius or use attachment smooth, embedded or held");
    }
}

void bind_vertices(const pbs::Character& character, const FemOptions& options, BoneAttachment& bones)
{
    bones.binding = character.binding;
    bones.attachment.bind_distance = character.binding.distance;
    bones.attachment.bind_stiffness =
        options.used_spring_factor() * options.young_pa * pbs::lumped_volumes(character.mesh.rest, character.mesh.tets);
    for (Eigen::Index v = 0; v < character.mesh.rest.rows(); ++v) {
        const double radius = bones.capsules[character.binding.bone[v]].radius_m;
        bones.attachment.bind_stiffness(v) /= radius * radius;
    }
}

// Springs at the sample points of the capsules, each with the stiffness of its share of the volume.
void tie_springs(const pbs::Character& character, const FemOptions& options, BoneAttachment& bones)
{
    pbs::CapsuleSprings held =
        pbs::bone_springs(character, spring_placement(options.attachment), spring_options(options));
    bones.capsules = std::move(held.capsules);
    bones.attachment.spring_points = std::move(held.springs.points);
    bones.attachment.spring_stiffness = options.young_pa * held.springs.stiffness;
    bones.spring_bone = std::move(held.springs.bone);
    bones.spring_density = std::move(held.density);
    bones.loose_parts = held.loose_parts;
    bones.loose_share = held.loose_share;
}

}  // namespace

BoneAttachment bone_attachment(const pbs::Character& character, const FemOptions& options)
{
    BoneAttachment bones;
    bones.vertex_bone.assign(character.mesh.rest.rows(), -1);
    if (options.has_sample_points()) {
        tie_springs(character, options, bones);
        return bones;
    }
    constexpr double whole_limb = 1.0;
    bones.capsules = pbs::bone_capsules(character, options.has_capsules() ? options.used_core_radius() : whole_limb);
    if (options.attachment == FemAttachment::bind)
        bind_vertices(character, options, bones);
    else if (character.refinements > 0)
        hold_children(bone_attachment(*character.unrefined, options), character, bones);
    else
        hold_tets(character, bones);
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
    for (const auto& [place, sum] : stiffness) {
        if (sum <= largest[place.first]) continue;
        largest[place.first] = sum;
        gripping[place.first] = place.second;
    }
    return gripping;
}

reference_fem::Targets targets(const BoneAttachment& bones, const pbs::Positions& rest, const pbs::Pose& pose)
{
    reference_fem::Targets held{bones.attachment.spring_points, rest, pbs::posed_bind_points(bones.binding, pose)};
    const auto carry = [&](auto point, int bone) { point = (pose[bone] * pbs::Vec3(point.transpose())).transpose(); };
    for (Eigen::Index s = 0; s < held.springs.rows(); ++s) carry(held.springs.row(s), bones.spring_bone[s]);
    for (Eigen::Index v = 0; v < rest.rows(); ++v)
        if (bones.vertex_bone[v] >= 0) carry(held.vertices.row(v), bones.vertex_bone[v]);
    return held;
}

}  // namespace experiments

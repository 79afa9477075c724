#include "pbs/character/overlap_mask.hpp"

#include "pbs/character/bone_capsules.hpp"
#include "pbs/geometry/meshing.hpp"
#include "pbs/geometry/topology.hpp"

namespace pbs {

OverlapMask::OverlapMask(const Character& character) : character_(character)
{
    constexpr double whole_limb = 1.0;
    const std::vector<BoneCapsule> limbs = bone_capsules(character, whole_limb);
    for (const int bone : character.binding.bone) limb_radius_m_.push_back(limbs[bone].radius_m);
    const std::vector<bool> on_skin = boundary_vertices(character.mesh.tets, character.mesh.rest.rows());
    for (std::size_t v = 0; v < on_skin.size(); ++v)
        if (on_skin[v]) skin_.push_back(static_cast<int>(v));
}

std::vector<bool> OverlapMask::of(const Positions& reference) const
{
    const Positions& rest = character_.mesh.rest;
    std::vector<bool> masked(rest.rows(), false);
    for (const int inside : vertices_inside_other_tets(reference, character_.mesh.tets, skin_))
        for (Eigen::Index v = 0; v < rest.rows(); ++v)
            if ((rest.row(v) - rest.row(inside)).norm() <= limb_radius_m_[inside]) masked[v] = true;
    return masked;
}

}  // namespace pbs

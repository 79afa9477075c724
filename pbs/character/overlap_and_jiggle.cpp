#include "pbs/character/overlap_and_jiggle.hpp"

#include "pbs/character/bone_capsules.hpp"
#include "pbs/geometry/meshing.hpp"
#include "pbs/geometry/topology.hpp"

#include <algorithm>

namespace pbs {
namespace {

std::vector<std::vector<int>> pieces_of(const std::vector<bool>& zone, const Tets& tets)
{
    const Adjacency edges = adjacency_of(tets, static_cast<int>(zone.size()));
    std::vector<bool> seen(zone.size(), false);
    std::vector<std::vector<int>> pieces;
    for (int start = 0; start < static_cast<int>(zone.size()); ++start) {
        if (!zone[start] || seen[start]) continue;
        std::vector<int> piece = {start};
        seen[start] = true;
        for (std::size_t next = 0; next < piece.size(); ++next)
            for (int i = edges.first[piece[next]]; i < edges.first[piece[next] + 1]; ++i) {
                const int neighbour = edges.neighbour[i];
                if (!zone[neighbour] || seen[neighbour]) continue;
                seen[neighbour] = true;
                piece.push_back(neighbour);
            }
        pieces.push_back(std::move(piece));
    }
    std::stable_sort(pieces.begin(), pieces.end(), [](const auto& a, const auto& b) { return a.size() > b.size(); });
    return pieces;
}

std::vector<BoneInZone> bones_of(const std::vector<bool>& zone, const Character& character)
{
    std::vector<int> all(character.skeleton.bones.size(), 0), inside(all);
    for (std::size_t v = 0; v < zone.size(); ++v) {
        ++all[character.binding.bone[v]];
        inside[character.binding.bone[v]] += zone[v];
    }
    const double total = static_cast<double>(std::count(zone.begin(), zone.end(), true));
    std::vector<BoneInZone> bones;
    for (std::size_t b = 0; b < all.size(); ++b)
        if (inside[b] > 0) bones.push_back({character.skeleton.bones[b].name, inside[b] / total, static_cast<double>(inside[b]) / all[b]});
    std::stable_sort(bones.begin(), bones.end(), [](const auto& a, const auto& b) { return a.share_of_zone > b.share_of_zone; });
    return bones;
}

}  // namespace

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

ZoneContents zone_contents(const Character& character)
{
    const std::vector<bool> zone = jiggle_zone(character.binding);
    const std::vector<bool> skin = boundary_vertices(character.mesh.tets, character.mesh.rest.rows());
    ZoneContents contents;
    contents.pieces = pieces_of(zone, character.mesh.tets);
    contents.bones = bones_of(zone, character);
    double inside = 0.0, on_skin = 0.0;
    for (std::size_t v = 0; v < zone.size(); ++v) {
        inside += zone[v];
        on_skin += zone[v] && skin[v];
    }
    contents.share = zone.empty() ? 0.0 : inside / static_cast<double>(zone.size());
    contents.skin_share = inside > 0.0 ? on_skin / inside : 0.0;
    return contents;
}

}  // namespace pbs

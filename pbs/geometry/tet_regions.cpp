#include "pbs/geometry/tet_regions.hpp"

#include "pbs/geometry/topology.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace pbs {
namespace {

constexpr int none = -1;
using Neighbours = std::vector<std::array<int, 4>>;  // over the faces of each tet, opposite to its vertices; or none

// A face in more than two tets joins the first two.
Neighbours neighbours_over_faces(const Tets& tets)
{
    Neighbours neighbours(tets.rows(), {none, none, none, none});
    std::map<std::array<int, 3>, std::pair<int, int>> open;  // face -> tet and place of the face that wait for the other side
    for (int t = 0; t < tets.rows(); ++t)
        for (int opposite = 0; opposite < 4; ++opposite) {
            std::array<int, 3> face;
            for (int v = 0, corner = 0; v < 4; ++v)
                if (v != opposite) face[corner++] = tets(t, v);
            std::ranges::sort(face);
            const auto [found, is_first] = open.try_emplace(face, t, opposite);
            if (is_first) continue;
            const auto [other, place] = found->second;
            if (neighbours[other][place] != none) continue;
            neighbours[other][place] = t;
            neighbours[t][opposite] = other;
        }
    return neighbours;
}

// Takes tets without a region, breadth-first from `first`, until there are `most`; calls take(tet) for each.
template <typename IsFree, typename Take>
std::vector<int> grow(int first, const Neighbours& neighbours, std::size_t most, const IsFree& is_free, const Take& take)
{
    std::vector<int> grown = {first};
    take(first);
    for (std::size_t done = 0; done < grown.size(); ++done)
        for (const int t : neighbours[grown[done]]) {
            if (t == none || grown.size() == most || !is_free(t)) continue;
            take(t);
            grown.push_back(t);
        }
    return grown;
}

std::vector<int> breadth_first(const Neighbours& neighbours)
{
    std::vector<bool> visited(neighbours.size(), false);
    std::vector<int> order;
    for (std::size_t t = 0; t < neighbours.size(); ++t) {
        if (visited[t]) continue;
        const std::vector<int> part = grow(
            static_cast<int>(t), neighbours, neighbours.size(), [&](int other) { return !visited[other]; },
            [&](int other) { visited[other] = true; });
        order.insert(order.end(), part.begin(), part.end());
    }
    return order;
}

// The other region with most faces to these tets of region `own`, the first of equals; none where there is no other one.
int nearest_region(const std::vector<int>& part, int own, const Neighbours& neighbours, const std::vector<int>& region)
{
    std::map<int, int> faces;
    for (const int t : part)
        for (const int other : neighbours[t])
            if (other != none && region[other] != own) ++faces[region[other]];
    int nearest = none;
    for (const auto& [of, count] : faces)
        if (nearest == none || count > faces[nearest]) nearest = of;
    return nearest;
}

}  // namespace

std::vector<int> tet_regions(const Tets& tets, int region_size)
{
    const Neighbours neighbours = neighbours_over_faces(tets);
    std::vector<int> region(tets.rows(), none);
    int regions = 0;
    for (const int first : breadth_first(neighbours)) {
        if (region[first] != none) continue;
        const std::vector<int> part = grow(
            first, neighbours, region_size, [&](int t) { return region[t] == none; }, [&](int t) { region[t] = regions; });
        const bool is_small = 2 * part.size() < static_cast<std::size_t>(region_size);
        const int nearest = is_small ? nearest_region(part, regions, neighbours, region) : none;
        if (nearest == none)
            ++regions;
        else
            for (const int t : part) region[t] = nearest;
    }
    return region;
}

std::vector<Triangles> region_surfaces(const Tets& tets, const std::vector<int>& region)
{
    std::vector<std::vector<int>> members;
    for (std::size_t t = 0; t < region.size(); ++t) {
        if (region[t] >= static_cast<int>(members.size())) members.resize(region[t] + 1);
        members[region[t]].push_back(static_cast<int>(t));
    }
    std::vector<Triangles> surfaces;
    for (const std::vector<int>& of_region : members) {
        Tets own(of_region.size(), 4);
        for (std::size_t i = 0; i < of_region.size(); ++i) own.row(i) = tets.row(of_region[i]);
        surfaces.push_back(boundary_of(own));
    }
    return surfaces;
}

}  // namespace pbs
